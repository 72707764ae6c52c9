// libpliant.so and pliant.h lie in ThirdParty/Pliant of the plug-in, or are installed (package libpliant-dev).
using System.IO;
using UnrealBuildTool;

public class PliantUnreal : ModuleRules
{
    public PliantUnreal(ReadOnlyTargetRules Target) : base(Target)
    {
        PCHUsage = PCHUsageMode.UseExplicitOrSharedPCHs;
        PublicDependencyModuleNames.AddRange(new[] { "Core", "CoreUObject", "Engine", "ProceduralMeshComponent" });
        string folder = Path.Combine(PluginDirectory, "ThirdParty", "Pliant");
        if (Directory.Exists(folder))
        {
            PublicIncludePaths.Add(folder);
            string library = Path.Combine(folder, "libpliant.so");
            PublicAdditionalLibraries.Add(library);
            RuntimeDependencies.Add("$(BinaryOutputDir)/libpliant.so.0", library);
        }
        else
        {
            PublicSystemLibraries.Add("pliant");
        }
    }
}
