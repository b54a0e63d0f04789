// The component for Unreal without Unreal: the headers of `engine` stand for it. A sheet that keeps 10,000 springs burns
// for four seconds.
#include "SingeSheetComponent.h"

#include <algorithm>

namespace {

constexpr int Frames = 240;
constexpr double MillisecondsMax = 4;
bool Failed = false;

void Expect(const std::string &What, bool Yes) {
    printf("%s: %s\n", What.c_str(), Yes ? "yes" : "NO");
    Failed = Failed || !Yes;
}

} // namespace

int main() {
    USingeSheetComponent Sheet{FObjectInitializer()};
    Expect("without a start there is no pin", !Sheet.Pin(FVector(), 1));
    Sheet.Material = "unobtainium";
    Expect("an unknown material does not start", !Sheet.Begin());
    Sheet.Material = "newsprint";
    Sheet.Cells = FIntPoint(0, 4);
    Expect("no cells do not start", !Sheet.Begin());
    Expect("each with a reason", Errors.size() == 3 && Errors[1].find("there is no material") != std::string::npos);
    Sheet.Cells = FIntPoint(36, 36);
    Sheet.Size = FVector2D(20, 20);
    Expect("it starts", Sheet.Begin());
    Expect("it stands upright, 20 cm wide and high",
           std::abs(Sheet.High.X - 10) < 1e-3 && std::abs(Sheet.Low.Z + 10) < 1e-3 && Sheet.High.Y < 0.1);
    Expect("fronts turn as normals say", Sheet.Backwards == 0 && Sheet.Bad == 0);
    Expect("corners are pinned", Sheet.Pin(FVector(-10, 0, 10), 0.5f) && Sheet.Pin(FVector(10, 0, 10), 0.5f));
    Expect("a match burns", Sheet.Ignite(FVector(0, 0, -9), 1.2f, 0.6f));
    Expect("wind blows", Sheet.Blow(FVector(0, 50, 0), 10));
    Expect("a wall is there", Sheet.AddPlane(FVector(0, -30, 0), FVector(0, 1, 0)));
    Expect("a ball is there", Sheet.AddSphere(FVector(0, -20, -10), 3));
    Expect("a match of no size that can be is refused", !Sheet.Ignite(FVector(), -1, 0.5f));

    double Used[Frames];
    for (int Warm = 0; Warm < 2; Warm++) Sheet.TickComponent(1 / 60.f, LEVELTICK_All, nullptr);
    const int64 Allocations = Sheet.GetAllocations();
    double Aside = 0;
    for (double &Frame : Used) {
        Sheet.TickComponent(1 / 60.f, LEVELTICK_All, nullptr);
        Frame = Sheet.GetProcessorMilliseconds();
        Aside = std::max(Aside, Sheet.High.Y);
    }
    std::sort(Used, Used + Frames);
    Expect(std::to_string(100 * Sheet.GetBurnt()) + " % has burnt", Sheet.GetBurnt() > 0.05f);
    Expect("it still has 10,000 springs (" + std::to_string(Sheet.GetSprings()) + ")", Sheet.GetSprings() >= 10000);
    Expect("wind along y bends it along y (" + std::to_string(Aside) + " cm)", Aside > 0.5);
    Expect(std::to_string(Sheet.Triangles) + " triangles are drawn", Sheet.Triangles > 1000);
    Expect(std::to_string(Sheet.GetAllocations() - Allocations) + " allocations", Sheet.GetAllocations() == Allocations);
    printf("a frame of %d springs: median %.2f ms of the processor, 95 %% within %.2f\n", Sheet.GetSprings(),
           Used[Frames / 2], Used[Frames * 95 / 100]);
    Expect("median within 4 ms", Used[Frames / 2] <= MillisecondsMax);
    Sheet.EndPlay(EEndPlayReason::Destroyed);
    Expect("after its end it is gone", Sheet.GetSprings() == 0 && !Sheet.Blow(FVector(), 0));
    printf("unreal's component: %s\n", Failed ? "failed" : "all good");
    return Failed;
}
