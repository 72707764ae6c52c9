// A Pliant level as an Unreal component: the component's place moves the first probe, a procedural mesh of the same
// actor shows an object as it is dented, Force is felt.
#pragma once

#include "Components/SceneComponent.h"
#include "CoreMinimal.h"
#include "PliantComponent.generated.h"

struct pliant_scene;
struct pliant_session;

UCLASS(ClassGroup = (Physics), meta = (BlueprintSpawnableComponent))
class PLIANTUNREAL_API UPliantComponent : public USceneComponent {
  GENERATED_BODY()

 public:
  UPliantComponent();

  UPROPERTY(EditAnywhere, Category = "Pliant")
  FString Level;  // path of a level or a mesh
  UPROPERTY(EditAnywhere, Category = "Pliant")
  FString Shown;  // object in the procedural mesh; empty: the first
  UPROPERTY(EditAnywhere, Category = "Pliant")
  FString Device;  // driver that moves the probe instead of this component; empty: none

  UPROPERTY(BlueprintReadOnly, Category = "Pliant")
  FVector Force = FVector::ZeroVector;  // [N] on the hand, Unreal's axes
  UPROPERTY(BlueprintReadOnly, Category = "Pliant")
  bool Touching = false;
  UPROPERTY(BlueprintReadOnly, Category = "Pliant")
  FString Error;  // of the library; empty: none

  virtual void BeginPlay() override;
  virtual void EndPlay(const EEndPlayReason::Type Reason) override;
  virtual void TickComponent(float Seconds, ELevelTick Type, FActorComponentTickFunction* Function) override;

 private:
  bool Open();
  bool MakeMesh();
  bool Move();
  bool ReadVertices();
  bool Done(int32 Status);  // false: Error has the sentence
  void Close();

  pliant_scene* Scene = nullptr;
  pliant_session* Session = nullptr;
  FString Effector;
  TArray<FVector> Positions, Normals;
  TArray<int32> Triangles;
  TArray<float> Buffer;
};
