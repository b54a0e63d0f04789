// A rectangle of paper or cloth that burns in the scene. Put it on an object with a MeshRenderer whose material multiplies
// by vertex colours (red, green, blue) and glows by their alpha; set the properties and call Begin.
using System;
using System.Runtime.InteropServices;
using System.Text;
using UnityEngine;
using UnityEngine.Rendering;

[RequireComponent(typeof(MeshFilter), typeof(MeshRenderer))]
public class SingeSheet : MonoBehaviour
{
    const string Library = "singe_unity";

    [StructLayout(LayoutKind.Sequential)]
    struct Settings
    {
        public float width, height;
        public int columns, rows, threads;
        public float pace, detail;
        public Vector3 gravity;
    }

    [StructLayout(LayoutKind.Sequential)]
    struct State
    {
        public int vertices, triangles, springs;
        public float burnt;
        public double milliseconds, processorMilliseconds;
        public long allocations;
    }

    [DllImport(Library)]
    static extern IntPtr singe_unity_start(ref Settings settings, byte[] material, byte[] why, int size);
    [DllImport(Library)]
    static extern void singe_unity_stop(IntPtr sheet);
    [DllImport(Library)]
    static extern int singe_unity_advance(IntPtr sheet, double seconds, byte[] why, int size);
    [DllImport(Library)]
    static extern int singe_unity_pin(IntPtr sheet, ref Vector3 point, float radius, byte[] why, int size);
    [DllImport(Library)]
    static extern int singe_unity_ignite(IntPtr sheet, ref Vector3 point, float radius, float seconds, byte[] why, int size);
    [DllImport(Library)]
    static extern int singe_unity_blow(IntPtr sheet, ref Vector3 velocity, float gust, byte[] why, int size);
    [DllImport(Library)]
    static extern int singe_unity_add_sphere(IntPtr sheet, ref Vector3 centre, float radius, byte[] why, int size);
    [DllImport(Library)]
    static extern int singe_unity_add_plane(IntPtr sheet, ref Vector3 point, ref Vector3 normal, byte[] why, int size);
    [DllImport(Library)]
    static extern void singe_unity_state(IntPtr sheet, out State state);
    [DllImport(Library)]
    static extern void singe_unity_read(IntPtr sheet, Vector3[] positions, Vector3[] normals, Vector2[] uv,
                                        Color32[] colours, int[] corners);

    [Tooltip("m, in the object's x-y plane")]
    public Vector2 size = new Vector2(0.21f, 0.21f);
    [Tooltip("ten springs for each cell")]
    public Vector2Int cells = new Vector2Int(32, 32);
    public string material = "office-paper";
    [Tooltip("seconds of fire a second")]
    public float pace = 8;
    [Tooltip("m; edges are ragged below it; 0: flat cells")]
    public float detail = 0;
    public int threads = 1;

    IntPtr sheet;
    State state;
    Mesh mesh;
    readonly byte[] why = new byte[512];
    // with room for what the sheet may become
    Vector3[] positions = new Vector3[0], normals = new Vector3[0];
    Vector2[] uv = new Vector2[0];
    Color32[] colours = new Color32[0];
    int[] corners = new int[0];

    public bool Burning => sheet != IntPtr.Zero;
    public float Burnt => state.burnt;
    public int Springs => state.springs;
    public int Triangles => state.triangles;
    public double Milliseconds => state.milliseconds;
    public double ProcessorMilliseconds => state.processorMilliseconds;
    public long Allocations => state.allocations;

    bool Said(bool good, string what)
    {
        if (!good)
            Debug.LogError("SingeSheet: " + what + ": " + Encoding.UTF8.GetString(why, 0, Array.IndexOf(why, (byte)0)));
        return good;
    }

    bool Ready(string what)
    {
        if (!Burning)
            Debug.LogError("SingeSheet: " + what + ": the sheet has not started");
        return Burning;
    }

    /// Makes the sheet; false, with an error in the log, where something is out of range.
    public bool Begin()
    {
        End();
        var settings = new Settings
        {
            width = size.x, height = size.y, columns = cells.x, rows = cells.y, threads = threads, pace = pace,
            detail = detail, gravity = transform.InverseTransformDirection(Physics.gravity)
        };
        sheet = singe_unity_start(ref settings, Encoding.UTF8.GetBytes(material + "\0"), why, why.Length);
        if (!Said(Burning, "cannot start"))
            return false;
        if (mesh == null)
        {
            mesh = new Mesh { name = "SingeSheet", indexFormat = IndexFormat.UInt32 };
            mesh.MarkDynamic();
            GetComponent<MeshFilter>().sharedMesh = mesh;
        }
        Show();
        return true;
    }

    public void End()
    {
        if (Burning)
            singe_unity_stop(sheet);
        sheet = IntPtr.Zero;
    }

    // After Begin, at any time; m, m/s and s in the object's axes.

    public bool Pin(Vector3 point, float radius) =>
        Ready("pin") && Said(singe_unity_pin(sheet, ref point, radius, why, why.Length) != 0, "pin");

    public bool Ignite(Vector3 point, float radius, float seconds) =>
        Ready("ignite") && Said(singe_unity_ignite(sheet, ref point, radius, seconds, why, why.Length) != 0, "ignite");

    public bool Blow(Vector3 velocity, float gust) =>
        Ready("blow") && Said(singe_unity_blow(sheet, ref velocity, gust, why, why.Length) != 0, "blow");

    public bool AddSphere(Vector3 centre, float radius) =>
        Ready("sphere") && Said(singe_unity_add_sphere(sheet, ref centre, radius, why, why.Length) != 0, "sphere");

    public bool AddPlane(Vector3 point, Vector3 normal) =>
        Ready("plane") && Said(singe_unity_add_plane(sheet, ref point, ref normal, why, why.Length) != 0, "plane");

    void Update()
    {
        if (!Burning)
            return;
        if (Said(singe_unity_advance(sheet, Time.deltaTime, why, why.Length) != 0, "stands still"))
            Show();
        else
            End();
    }

    void Show()
    {
        singe_unity_state(sheet, out state);
        if (positions.Length < state.vertices)
        {
            var room = state.vertices + state.vertices / 2;
            positions = new Vector3[room];
            normals = new Vector3[room];
            uv = new Vector2[room];
            colours = new Color32[room];
        }
        if (corners.Length < 3 * state.triangles)
            corners = new int[3 * (state.triangles + state.triangles / 2)];
        singe_unity_read(sheet, positions, normals, uv, colours, corners);
        mesh.Clear(true);
        mesh.SetVertices(positions, 0, state.vertices);
        mesh.SetNormals(normals, 0, state.vertices);
        mesh.SetUVs(0, uv, 0, state.vertices);
        mesh.SetColors(colours, 0, state.vertices);
        mesh.SetTriangles(corners, 0, 3 * state.triangles, 0, true, 0);
    }

    void OnDestroy()
    {
        End();
        if (mesh != null)
            Destroy(mesh);
    }
}
