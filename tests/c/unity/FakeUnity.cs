// As much of Unity as the component uses, and a program that presses a level through it.
using System;
using System.Reflection;
using System.Threading;

namespace UnityEngine.Rendering
{
    public enum IndexFormat { UInt16, UInt32 }
}

namespace UnityEngine
{
    public struct Vector3
    {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
    }
    public struct Quaternion { public float x, y, z, w; }
    public class Transform { public Vector3 position; public Quaternion rotation = new Quaternion { w = 1 }; }
    public class Mesh
    {
        public Rendering.IndexFormat indexFormat;
        public Vector3[] vertices, normals;
        public int[] triangles;
        public void MarkDynamic() { }
    }
    public class MeshFilter { public Mesh mesh; }
    public static class Application { public static string streamingAssetsPath; }
    public static class Debug
    {
        public static string last = "";
        public static void LogError(string text) { last = text; }
    }
    public class MonoBehaviour
    {
        public bool enabled = true;
        public Transform transform = new Transform();
        readonly MeshFilter filter = new MeshFilter();
        public T GetComponent<T>() where T : class { return filter as T; }
    }
}

static class Program
{
    static void Call(object of, string name)
    {
        of.GetType().GetMethod(name, BindingFlags.NonPublic | BindingFlags.Instance).Invoke(of, null);
    }

    static void Expect(bool condition, string of)
    {
        if (condition) return;
        Console.WriteLine("failed: " + of);
        Environment.Exit(1);
    }

    static void Main(string[] arguments)
    {
        UnityEngine.Application.streamingAssetsPath = arguments[0];
        var wrong = new Pliant.PliantLevel { level = "none.glb" };
        Call(wrong, "OnEnable");
        Expect(!wrong.enabled && UnityEngine.Debug.last.Contains("none.glb"), UnityEngine.Debug.last);

        var level = new Pliant.PliantLevel { level = arguments[1] };
        level.transform.position.y = 1;
        Call(level, "OnEnable");
        Expect(level.enabled, UnityEngine.Debug.last);
        var mesh = level.GetComponent<UnityEngine.MeshFilter>().mesh;
        float top = -1;
        UnityEngine.Vector3 summit = new UnityEngine.Vector3();
        foreach (var vertex in mesh.vertices) if (vertex.y > top) { top = vertex.y; summit = vertex; }
        // Outward normals: at the summit, upward; the same by a triangle there, in Unity's clockwise order.
        int at = Array.IndexOf(mesh.vertices, summit);
        Expect(mesh.normals[at].y > 0.5f, "the normal at the summit");
        for (int i = 0; i < mesh.triangles.Length; i += 3)
        {
            if (mesh.triangles[i] != at) continue;
            var a = mesh.vertices[at];
            var b = mesh.vertices[mesh.triangles[i + 1]];
            var c = mesh.vertices[mesh.triangles[i + 2]];
            Expect((b.z - a.z) * (c.x - a.x) - (b.x - a.x) * (c.z - a.z) > 0, "the order of a triangle");
        }
        // Up and down until it is felt: on a busy machine a probe may be lost for a while.
        float most = 0;
        for (int frame = 0; frame < 2000 && !(most > 0.1f && mesh.vertices[at].y < summit.y - 0.0005f); ++frame)
        {
            float press = 0.0002f * (30 - Math.Abs(frame % 60 - 30));
            level.transform.position = new UnityEngine.Vector3(summit.x, summit.y + 0.002f - press, summit.z);
            Call(level, "Update");
            if (level.Touching) most = Math.Max(most, level.Force.y);
            Thread.Sleep(10);
        }
        Expect(most > 0.1f, "a force of " + most + " N");
        Expect(mesh.vertices[at].y < summit.y - 0.0005f, "the dent");
        Call(level, "OnDisable");
        Call(level, "OnDisable");
        Console.WriteLine("the largest force was " + most + " N");
    }
}
