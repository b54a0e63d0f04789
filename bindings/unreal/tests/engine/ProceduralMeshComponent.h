// The component that draws, standing for Unreal's: it keeps the last section and checks it.
#pragma once

#include "CoreMinimal.h"

struct FObjectInitializer {};
struct FActorComponentTickFunction {
    bool bCanEverTick = false;
};
enum ELevelTick { LEVELTICK_All };
namespace EEndPlayReason {
enum Type { Destroyed };
}
struct FProcMeshTangent {};

struct FTransform {
    FVector InverseTransformVectorNoScale(const FVector &Vector) const { return Vector; }
};

struct UWorld {
    float GetGravityZ() const { return -980; }
};

class UProceduralMeshComponent {
  public:
    explicit UProceduralMeshComponent(const FObjectInitializer &) {}
    virtual ~UProceduralMeshComponent() = default;
    virtual void TickComponent(float, ELevelTick, FActorComponentTickFunction *) {}
    virtual void EndPlay(const EEndPlayReason::Type) {}
    const FTransform &GetComponentTransform() const { return Transform; }
    const UWorld *GetWorld() const { return &World; }

    void CreateMeshSection(int32, const TArray<FVector> &Positions, const TArray<int32> &Corners,
                           const TArray<FVector> &Normals, const TArray<FVector2D> &Coordinates,
                           const TArray<FColor> &Colours, const TArray<FProcMeshTangent> &, bool) {
        Triangles = Corners.Num() / 3;
        Backwards = Bad = 0;
        Low = FVector(1e9, 1e9, 1e9);
        High = FVector(-1e9, -1e9, -1e9);
        Bad += Normals.Num() != Positions.Num() || Coordinates.Num() != Positions.Num() ||
               Colours.Num() != Positions.Num();
        for (int32 T = 0; T < Triangles; T++) {
            const FVector &A = Positions[Corners[3 * T]], &B = Positions[Corners[3 * T + 1]],
                          &C = Positions[Corners[3 * T + 2]], &N = Normals[Corners[3 * T]];
            const double U[3] = {B.X - A.X, B.Y - A.Y, B.Z - A.Z}, V[3] = {C.X - A.X, C.Y - A.Y, C.Z - A.Z};
            Backwards += (U[1] * V[2] - U[2] * V[1]) * N.X + (U[2] * V[0] - U[0] * V[2]) * N.Y +
                             (U[0] * V[1] - U[1] * V[0]) * N.Z <
                         0;
        }
        for (int32 V = 0; V < Positions.Num(); V++) {
            const FVector &P = Positions[V];
            Low = FVector(P.X < Low.X ? P.X : Low.X, P.Y < Low.Y ? P.Y : Low.Y, P.Z < Low.Z ? P.Z : Low.Z);
            High = FVector(P.X > High.X ? P.X : High.X, P.Y > High.Y ? P.Y : High.Y, P.Z > High.Z ? P.Z : High.Z);
        }
    }

    // of the last section
    int32 Triangles = 0, Backwards = 0, Bad = 0;
    FVector Low, High;

  protected:
    FActorComponentTickFunction PrimaryComponentTick;

  private:
    FTransform Transform;
    UWorld World;
};
