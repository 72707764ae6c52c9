// As much of Unreal's types as the component names: it only compiles with them.
#pragma once
#include <cstdarg>
#include <cstdint>
#include <initializer_list>
#define UCLASS(...)
#define UPROPERTY(...)
#define GENERATED_BODY() using Super = USceneComponent;
#define PLIANTUNREAL_API
#define TEXT(x) x
#define UE_LOG(...) ((void)0)
#define IMPLEMENT_MODULE(...)
#define UTF8_TO_TCHAR(x) (x)
#define TCHAR_TO_UTF8(x) (x)
using int32 = std::int32_t;
enum ELevelTick { LEVELTICK_All };
namespace EEndPlayReason {
enum Type { Quit };
}
struct FActorComponentTickFunction {
  bool bCanEverTick;
};
struct FVector {
  double X, Y, Z;
  FVector(double x = 0, double y = 0, double z = 0) : X(x), Y(y), Z(z) {}
  static const FVector ZeroVector;
};
FVector operator*(double, const FVector&);
struct FQuat {
  double X, Y, Z, W;
};
struct FString {
  FString(const char* = "");
  bool IsEmpty() const;
  const char* operator*() const;
};
template <class T>
struct TArray {
  TArray() = default;
  TArray(std::initializer_list<T>) {}
  void SetNum(int32);
  int32 Num() const;
  T* GetData();
  T& operator[](int32);
};
struct UProceduralMeshComponent {
  void CreateMeshSection(int32, const TArray<FVector>&, const TArray<int32>&, const TArray<FVector>&,
                         const TArray<int>&, const TArray<int>&, const TArray<int>&, bool);
  void UpdateMeshSection(int32, const TArray<FVector>&, const TArray<FVector>&, const TArray<int>&, const TArray<int>&,
                         const TArray<int>&);
};
struct AActor {
  template <class T>
  T* FindComponentByClass() const;
};
struct USceneComponent {
  FActorComponentTickFunction PrimaryComponentTick;
  virtual ~USceneComponent() = default;
  virtual void BeginPlay();
  virtual void EndPlay(EEndPlayReason::Type);
  virtual void TickComponent(float, ELevelTick, FActorComponentTickFunction*);
  AActor* GetOwner() const;
  FVector GetComponentLocation() const;
  FQuat GetComponentQuat() const;
};
