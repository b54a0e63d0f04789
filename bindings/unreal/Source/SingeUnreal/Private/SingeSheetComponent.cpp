// Unreal's axes are left-handed with z up, and its unit is the centimetre. The sheet's x is our x, its y our z, and its z, the
// side that its front faces, our y. That mirrors, so triangles turn the other way.
#include "SingeSheetComponent.h"

#include "burning_sheet.h"

DEFINE_LOG_CATEGORY_STATIC(LogSinge, Log, All);

namespace {

constexpr float Metre = 100; // cm

FVector Outside(const float Inside[3], float Scale) {
    return FVector(Scale * Inside[0], Scale * Inside[2], Scale * Inside[1]);
}

void Inside(const FVector &Outside, float Scale, float To[3]) {
    To[0] = static_cast<float>(Outside.X) / Scale;
    To[1] = static_cast<float>(Outside.Z) / Scale;
    To[2] = static_cast<float>(Outside.Y) / Scale;
}

} // namespace

USingeSheetComponent::USingeSheetComponent(const FObjectInitializer &Initializer) : Super(Initializer) {
    PrimaryComponentTick.bCanEverTick = true;
}

USingeSheetComponent::~USingeSheetComponent() { End(); }

bool USingeSheetComponent::Said(bool Good, const TCHAR *What) {
    if (!Good) UE_LOG(LogSinge, Error, TEXT("%s: %s"), What, UTF8_TO_TCHAR(Sheet->error.message));
    return Good;
}

bool USingeSheetComponent::Ready(const TCHAR *What) {
    if (!Sheet) UE_LOG(LogSinge, Error, TEXT("%s: the sheet has not started"), What);
    return Sheet.IsValid();
}

bool USingeSheetComponent::Begin() {
    End();
    Sheet = MakeUnique<BurningSheet>(burning_default());
    Sheet->size[0] = static_cast<float>(Size.X) / Metre;
    Sheet->size[1] = static_cast<float>(Size.Y) / Metre;
    Sheet->cells[0] = static_cast<uint32>(FMath::Max(Cells.X, 0));
    Sheet->cells[1] = static_cast<uint32>(FMath::Max(Cells.Y, 0));
    Sheet->pace = Pace;
    Sheet->detail = Detail / Metre;
    Sheet->threads = Threads;
    FCStringAnsi::Strncpy(Sheet->material, TCHAR_TO_UTF8(*Material), sizeof Sheet->material);
    const FVector Down = GetComponentTransform().InverseTransformVectorNoScale(FVector(0, 0, GetWorld()->GetGravityZ()));
    Inside(Down, Metre, Sheet->gravity);
    if (!Said(burning_start(Sheet.Get()), TEXT("cannot start"))) {
        Sheet.Reset();
        return false;
    }
    Show();
    return true;
}

void USingeSheetComponent::End() {
    if (Sheet) burning_stop(Sheet.Get());
    Sheet.Reset();
}

bool USingeSheetComponent::Pin(FVector Point, float Radius) {
    float At[3];
    Inside(Point, Metre, At);
    return Ready(TEXT("pin")) && Said(burning_pin(Sheet.Get(), At, Radius / Metre), TEXT("pin"));
}

bool USingeSheetComponent::Ignite(FVector Point, float Radius, float Seconds) {
    float At[3];
    Inside(Point, Metre, At);
    return Ready(TEXT("ignite")) && Said(burning_ignite(Sheet.Get(), At, Radius / Metre, Seconds), TEXT("ignite"));
}

bool USingeSheetComponent::Blow(FVector Velocity, float Gust) {
    float Wind[3];
    Inside(Velocity, Metre, Wind);
    return Ready(TEXT("blow")) && Said(burning_blow(Sheet.Get(), Wind, Gust / Metre), TEXT("blow"));
}

bool USingeSheetComponent::AddSphere(FVector Centre, float Radius) {
    float At[3];
    Inside(Centre, Metre, At);
    return Ready(TEXT("sphere")) && Said(burning_add_sphere(Sheet.Get(), At, Radius / Metre), TEXT("sphere"));
}

bool USingeSheetComponent::AddPlane(FVector Point, FVector Normal) {
    float At[3], Up[3];
    Inside(Point, Metre, At);
    Inside(Normal, 1, Up);
    return Ready(TEXT("plane")) && Said(burning_add_plane(Sheet.Get(), At, Up), TEXT("plane"));
}

float USingeSheetComponent::GetBurnt() const {
    return Sheet ? static_cast<float>(singe_sim_stats(Sheet->sim).burnt_fraction) : 0;
}

int32 USingeSheetComponent::GetSprings() const {
    return Sheet ? static_cast<int32>(singe_sim_stats(Sheet->sim).springs) : 0;
}

float USingeSheetComponent::GetProcessorMilliseconds() const {
    return Sheet ? static_cast<float>(Sheet->processor_time) : 0;
}

int64 USingeSheetComponent::GetAllocations() const { return Sheet ? static_cast<int64>(Sheet->allocations) : 0; }

void USingeSheetComponent::TickComponent(float Seconds, ELevelTick Kind, FActorComponentTickFunction *Function) {
    Super::TickComponent(Seconds, Kind, Function);
    if (!Sheet) return;
    if (Said(burning_advance(Sheet.Get(), Seconds), TEXT("stands still"))) Show();
    else End();
}

void USingeSheetComponent::EndPlay(const EEndPlayReason::Type Reason) {
    End();
    Super::EndPlay(Reason);
}

void USingeSheetComponent::Show() {
    const SingeSurface &Surface = Sheet->surface;
    const int32 Vertices = static_cast<int32>(Surface.vertex_count), Triangles = static_cast<int32>(Surface.triangle_count);
    Positions.SetNumUninitialized(Vertices, EAllowShrinking::No);
    Normals.SetNumUninitialized(Vertices, EAllowShrinking::No);
    Coordinates.SetNumUninitialized(Vertices, EAllowShrinking::No);
    Colours.SetNumUninitialized(Vertices, EAllowShrinking::No);
    Corners.SetNumUninitialized(3 * Triangles, EAllowShrinking::No);
    for (int32 V = 0; V < Vertices; V++) {
        Positions[V] = Outside(Surface.position[V], Metre);
        Normals[V] = Outside(Surface.normal[V], 1);
        Coordinates[V] = FVector2D(Surface.uv[V][0], 1 - Surface.uv[V][1]);
        uint8 Colour[4];
        burning_colour(Surface.temperature[V], Surface.temperature_peak[V], Surface.burn[V], Colour);
        Colours[V] = FColor(Colour[0], Colour[1], Colour[2], Colour[3]);
    }
    for (int32 T = 0; T < Triangles; T++)
        for (int32 K = 0; K < 3; K++) Corners[3 * T + K] = static_cast<int32>(Surface.triangles[T][2 - K]);
    // topology changes from frame to frame, so the section is made anew
    CreateMeshSection(0, Positions, Corners, Normals, Coordinates, Colours, TArray<FProcMeshTangent>(), false);
}
