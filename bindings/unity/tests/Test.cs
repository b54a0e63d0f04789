// The script of the plug-in without Unity: Engine.cs stands for it. A sheet that keeps 10,000 springs burns for four
// seconds.
using System;
using UnityEngine;

static class Test
{
    const int Frames = 240;
    const double MillisecondsMax = 4;
    static bool failed;

    static void Expect(string what, bool yes)
    {
        Console.WriteLine(what + ": " + (yes ? "yes" : "NO"));
        failed = failed || !yes;
    }

    static int Main()
    {
        var sheet = new SingeSheet();
        Expect("without a start there is no pin", !sheet.Pin(new Vector3(), 0.01f));
        sheet.material = "unobtainium";
        Expect("an unknown material does not start", !sheet.Begin());
        sheet.material = "newsprint";
        sheet.cells = new Vector2Int(0, 4);
        Expect("no cells do not start", !sheet.Begin());
        Expect("each with a reason", Debug.errors.Count == 3 && Debug.errors[1].Contains("there is no material"));
        sheet.cells = new Vector2Int(36, 36);
        sheet.size = new Vector2(0.2f, 0.2f);
        Expect("it starts", sheet.Begin());
        var mesh = sheet.GetComponent<MeshFilter>().sharedMesh;
        Expect("fronts turn clockwise", mesh.backwards == 0);
        Expect("corners are pinned", sheet.Pin(new Vector3(-0.1f, 0.1f, 0), 0.005f) &
                                     sheet.Pin(new Vector3(0.1f, 0.1f, 0), 0.005f));
        Expect("a match burns", sheet.Ignite(new Vector3(0, -0.09f, 0), 0.012f, 0.6f));
        Expect("wind blows", sheet.Blow(new Vector3(0, 0, 0.5f), 0.1f));
        Expect("a wall is there", sheet.AddPlane(new Vector3(0, 0, -0.3f), new Vector3(0, 0, 1)));
        Expect("a ball is there", sheet.AddSphere(new Vector3(0, -0.1f, -0.2f), 0.03f));
        Expect("a match of no size that can be is refused", !sheet.Ignite(new Vector3(), -1, 0.5f));

        var used = new double[Frames];
        sheet.Frame();
        sheet.Frame();
        GC.Collect();
        long allocations = sheet.Allocations, collections = GC.CollectionCount(0), before = GC.GetTotalMemory(true);
        for (int i = 0; i < Frames; i++)
        {
            sheet.Frame();
            used[i] = sheet.ProcessorMilliseconds;
        }
        long after = GC.GetTotalMemory(false);
        Array.Sort(used);
        Expect(100 * sheet.Burnt + " % has burnt", sheet.Burnt > 0.05f);
        Expect("it still has 10,000 springs (" + sheet.Springs + ")", sheet.Springs >= 10000);
        Expect("wind along z bends it along z (" + 1e3 * mesh.high.z + " mm)", mesh.high.z > 0.005f);
        Expect(mesh.triangles + " triangles are drawn", mesh.triangles > 1000 && mesh.triangles == sheet.Triangles);
        Expect(sheet.Allocations - allocations + " allocations in " + Frames + " frames", sheet.Allocations == allocations);
        Expect(GC.CollectionCount(0) - collections + " collections, " + (after - before) + " bytes of garbage",
               GC.CollectionCount(0) == collections && after - before < 65536);
        Console.WriteLine("a frame of " + sheet.Springs + " springs: median " + used[Frames / 2].ToString("0.00") +
                          " ms of the processor, 95 % within " + used[Frames * 95 / 100].ToString("0.00"));
        Expect("median within " + MillisecondsMax + " ms", used[Frames / 2] <= MillisecondsMax);
        sheet.End();
        Expect("after its end it is gone", !sheet.Burning && !sheet.Blow(new Vector3(), 0));
        Console.WriteLine("unity's script: " + (failed ? "failed" : "all good"));
        return failed ? 1 : 0;
    }
}
