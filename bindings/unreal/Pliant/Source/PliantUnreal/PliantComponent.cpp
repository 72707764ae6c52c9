#include "PliantComponent.h"

#include <pliant.h>

#include "GameFramework/Actor.h"
#include "ProceduralMeshComponent.h"

namespace {

// Pliant: metres, right-handed, Y up. Unreal: centimetres, left-handed, Z up. Swapping y and z changes the hand, too.
FVector ToUnreal(double X, double Y, double Z) {
  return FVector(X, Z, Y);
}

pliant_pose ToPliant(const FVector& At, const FQuat& Turn) {
  // An exchange of two axes mirrors the rotation: its vector part changes sign beside the exchange.
  return {{0.01 * At.X, 0.01 * At.Z, 0.01 * At.Y}, {-Turn.X, -Turn.Z, -Turn.Y, Turn.W}};
}

}  // namespace

UPliantComponent::UPliantComponent() {
  PrimaryComponentTick.bCanEverTick = true;
}

bool UPliantComponent::Done(int32 Status) {
  if (Status == PLIANT_OK) return true;
  Error = UTF8_TO_TCHAR(pliant_error_message());
  UE_LOG(LogTemp, Error, TEXT("%s"), *Error);
  return false;
}

void UPliantComponent::BeginPlay() {
  Super::BeginPlay();
  if (!Open()) Close();
}

bool UPliantComponent::Open() {
  if (pliant_abi_version() != PLIANT_ABI_VERSION) {
    Error = TEXT("libpliant.so and pliant.h are of different versions");
    return false;
  }
  if (!Done(pliant_scene_load(TCHAR_TO_UTF8(*Level), nullptr, &Scene)) ||
      !Done(pliant_session_open(Scene, nullptr, nullptr, &Session)))
    return false;
  const char* Name = nullptr;
  if (!Done(pliant_session_effector(Session, 0, &Name))) return false;
  Effector = UTF8_TO_TCHAR(Name);
  if (Shown.IsEmpty()) {
    if (!Done(pliant_session_object(Session, 0, &Name))) return false;
    Shown = UTF8_TO_TCHAR(Name);
  }
  if (!MakeMesh()) return false;
  if (!Device.IsEmpty()) {
    if (!Done(pliant_register_all_drivers()) ||
        !Done(pliant_session_connect(Session, TCHAR_TO_UTF8(*Effector), TCHAR_TO_UTF8(*Device))))
      return false;
  } else if (!Move()) {
    return false;
  }
  return Done(pliant_session_start(Session));
}

bool UPliantComponent::MakeMesh() {
  size_t Vertices = 0, Indices = 0;
  if (!Done(pliant_session_vertices(Session, TCHAR_TO_UTF8(*Shown), nullptr, 0, &Vertices)) ||
      !Done(pliant_session_triangles(Session, TCHAR_TO_UTF8(*Shown), nullptr, 0, &Indices)))
    return false;
  Positions.SetNum(int32(Vertices));
  Normals.SetNum(int32(Vertices));
  Buffer.SetNum(int32(3 * Vertices));
  Triangles.SetNum(int32(Indices));
  // Unreal's front faces are counter-clockwise in its left-handed axes: the mirrored order is the same.
  if (!Done(pliant_session_triangles(Session, TCHAR_TO_UTF8(*Shown), reinterpret_cast<uint32_t*>(Triangles.GetData()),
                                     Indices, &Indices)))
    return false;
  if (!ReadVertices()) return false;
  if (UProceduralMeshComponent* Mesh = GetOwner()->FindComponentByClass<UProceduralMeshComponent>())
    Mesh->CreateMeshSection(0, Positions, Triangles, Normals, {}, {}, {}, false);
  return true;
}

bool UPliantComponent::Move() {
  const pliant_pose Pose = ToPliant(GetComponentLocation(), GetComponentQuat());
  return Done(pliant_session_move(Session, TCHAR_TO_UTF8(*Effector), Pose));
}

bool UPliantComponent::ReadVertices() {
  size_t Count = Positions.Num();
  if (!Done(pliant_session_vertices(Session, TCHAR_TO_UTF8(*Shown), Buffer.GetData(), Count, &Count))) return false;
  for (int32 i = 0; i < Positions.Num(); ++i)
    Positions[i] = 100.0 * ToUnreal(Buffer[3 * i], Buffer[3 * i + 1], Buffer[3 * i + 2]);
  if (!Done(pliant_session_normals(Session, TCHAR_TO_UTF8(*Shown), Buffer.GetData(), Count, &Count))) return false;
  for (int32 i = 0; i < Normals.Num(); ++i) Normals[i] = ToUnreal(Buffer[3 * i], Buffer[3 * i + 1], Buffer[3 * i + 2]);
  return true;
}

void UPliantComponent::TickComponent(float Seconds, ELevelTick Type, FActorComponentTickFunction* Function) {
  Super::TickComponent(Seconds, Type, Function);
  if (!Session) return;
  pliant_reading Reading = {};
  Reading.size = sizeof Reading;
  if ((Device.IsEmpty() && !Move()) || !Done(pliant_session_reading(Session, TCHAR_TO_UTF8(*Effector), &Reading)) ||
      !ReadVertices())
    return Close();
  Force = ToUnreal(Reading.force.x, Reading.force.y, Reading.force.z);
  Touching = Reading.touching != 0;
  if (UProceduralMeshComponent* Mesh = GetOwner()->FindComponentByClass<UProceduralMeshComponent>())
    Mesh->UpdateMeshSection(0, Positions, Normals, {}, {}, {});
}

void UPliantComponent::EndPlay(const EEndPlayReason::Type Reason) {
  Close();
  Super::EndPlay(Reason);
}

// The force of a device is zero before this returns.
void UPliantComponent::Close() {
  pliant_session_destroy(Session);
  pliant_scene_destroy(Scene);
  Session = nullptr;
  Scene = nullptr;
}
