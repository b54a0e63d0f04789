// A rectangle of a material that burns in the scene. It stands upright in the component's x-z plane. Lengths are in cm.
#pragma once

#include "CoreMinimal.h"
#include "ProceduralMeshComponent.h"

#include "SingeSheetComponent.generated.h"

struct BurningSheet;

UCLASS(ClassGroup = (Singe), meta = (BlueprintSpawnableComponent))
class SINGEUNREAL_API USingeSheetComponent : public UProceduralMeshComponent {
    GENERATED_BODY()

  public:
    USingeSheetComponent(const FObjectInitializer &Initializer);
    virtual ~USingeSheetComponent() override;

    UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = "Singe", meta = (Units = "cm"))
    FVector2D Size = FVector2D(21, 21);

    /// Ten springs for each.
    UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = "Singe")
    FIntPoint Cells = FIntPoint(32, 32);

    /// Of `singe materials`.
    UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = "Singe")
    FString Material = TEXT("office-paper");

    /// Seconds of fire a second.
    UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = "Singe")
    float Pace = 8;

    /// Edges are ragged below it; 0: flat cells.
    UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = "Singe", meta = (Units = "cm"))
    float Detail = 0;

    UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = "Singe")
    int32 Threads = 1;

    /// Makes the sheet; false, with an error in the log, where something is out of range. So for all below.
    UFUNCTION(BlueprintCallable, Category = "Singe")
    bool Begin();

    UFUNCTION(BlueprintCallable, Category = "Singe")
    void End();

    // After Begin, at any time, in the component's axes.

    UFUNCTION(BlueprintCallable, Category = "Singe")
    bool Pin(FVector Point, float Radius);

    UFUNCTION(BlueprintCallable, Category = "Singe")
    bool Ignite(FVector Point, float Radius, float Seconds);

    /// Wind in cm/s.
    UFUNCTION(BlueprintCallable, Category = "Singe")
    bool Blow(FVector Velocity, float Gust);

    UFUNCTION(BlueprintCallable, Category = "Singe")
    bool AddSphere(FVector Centre, float Radius);

    UFUNCTION(BlueprintCallable, Category = "Singe")
    bool AddPlane(FVector Point, FVector Normal);

    /// Share of the mass.
    UFUNCTION(BlueprintPure, Category = "Singe")
    float GetBurnt() const;

    UFUNCTION(BlueprintPure, Category = "Singe")
    int32 GetSprings() const;

    /// Cost of the last frame, of all of the process's threads.
    UFUNCTION(BlueprintPure, Category = "Singe")
    float GetProcessorMilliseconds() const;

    /// Memory asked for since Begin.
    UFUNCTION(BlueprintPure, Category = "Singe")
    int64 GetAllocations() const;

    virtual void TickComponent(float Seconds, ELevelTick Kind, FActorComponentTickFunction *Function) override;
    virtual void EndPlay(const EEndPlayReason::Type Reason) override;

  private:
    bool Said(bool Good, const TCHAR *What);
    bool Ready(const TCHAR *What);
    void Show();

    TUniquePtr<BurningSheet> Sheet;
    // with room for what the sheet may become
    TArray<FVector> Positions, Normals;
    TArray<FVector2D> Coordinates;
    TArray<FColor> Colours;
    TArray<int32> Corners;
};
