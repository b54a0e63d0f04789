// The module is not named Singe: Unreal would define SINGE_API for it, which is a word of our headers.
// The library and its headers lie in ThirdParty: docs/engines.md says how they get there.
using System.IO;
using UnrealBuildTool;

public class SingeUnreal : ModuleRules
{
    public SingeUnreal(ReadOnlyTargetRules Target) : base(Target)
    {
        PublicDependencyModuleNames.AddRange(new[] { "Core", "CoreUObject", "Engine", "ProceduralMeshComponent" });
        string place = Path.Combine(PluginDirectory, "ThirdParty");
        PublicSystemIncludePaths.Add(Path.Combine(place, "include"));
        bool windows = Target.Platform == UnrealTargetPlatform.Win64;
        PublicAdditionalLibraries.Add(Path.Combine(place, "lib", windows ? "singe_unreal.lib" : "libsinge_unreal.a"));
    }
}
