// In place of Unity: what SingeSheet uses of it, with its own checks. It is no part of the plug-in.
using System;
using System.Collections.Generic;
using System.Reflection;

namespace UnityEngine
{
    namespace Rendering
    {
        public enum IndexFormat { UInt16, UInt32 }
    }

    public struct Vector2 { public float x, y; public Vector2(float x, float y) { this.x = x; this.y = y; } }
    public struct Vector2Int { public int x, y; public Vector2Int(int x, int y) { this.x = x; this.y = y; } }
    public struct Color32 { public byte r, g, b, a; }
    public struct Vector3
    {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
    }

    public class RequireComponent : Attribute { public RequireComponent(Type a, Type b) { } }
    public class TooltipAttribute : Attribute { public TooltipAttribute(string text) { } }

    public class Object { public static void Destroy(Object what) { } }
    public class Component : Object { }
    public class Transform { public Vector3 InverseTransformDirection(Vector3 d) { return d; } }
    public static class Physics { public static Vector3 gravity = new Vector3(0, -9.81f, 0); }
    public static class Time { public static float deltaTime = 1f / 60; }
    public class MeshFilter : Component { public Mesh sharedMesh; }
    public class MeshRenderer : Component { }

    public static class Debug
    {
        public static List<string> errors = new List<string>();
        public static void LogError(string text) { errors.Add(text); }
    }

    public class MonoBehaviour : Component
    {
        public Transform transform = new Transform();
        MeshFilter filter = new MeshFilter();
        public T GetComponent<T>() where T : class { return filter as T; }
        MethodInfo update;
        Action frame;
        public void Frame() // as the engine calls what a script has
        {
            if (frame == null)
            {
                update = GetType().GetMethod("Update", BindingFlags.Instance | BindingFlags.NonPublic);
                frame = (Action)Delegate.CreateDelegate(typeof(Action), this, update);
            }
            frame();
        }
    }

    public class Mesh : Object
    {
        public string name;
        public Rendering.IndexFormat indexFormat;
        public Vector3 low, high;
        int vertices;
        public int triangles;
        public int backwards; // triangles whose front, which turns clockwise, is not on the side of their normals
        Vector3[] points, normals;
        public void MarkDynamic() { }
        public void Clear(bool keepLayout) { vertices = triangles = 0; }
        public void SetVertices(Vector3[] array, int start, int length)
        {
            vertices = length;
            points = array;
            low = new Vector3(1e9f, 1e9f, 1e9f);
            high = new Vector3(-1e9f, -1e9f, -1e9f);
            for (int i = start; i < start + length; i++)
            {
                low = new Vector3(Math.Min(low.x, array[i].x), Math.Min(low.y, array[i].y), Math.Min(low.z, array[i].z));
                high = new Vector3(Math.Max(high.x, array[i].x), Math.Max(high.y, array[i].y), Math.Max(high.z, array[i].z));
            }
        }
        void Same(int length) { if (length != vertices) throw new ArgumentException("array of another length"); }
        public void SetNormals(Vector3[] array, int start, int length)
        {
            Same(length);
            normals = array;
            for (int i = start; i < start + length; i++)
            {
                float square = array[i].x * array[i].x + array[i].y * array[i].y + array[i].z * array[i].z;
                if (Math.Abs(square - 1) > 1e-3f) throw new ArgumentException("a normal of another length than 1");
            }
        }
        public void SetUVs(int channel, Vector2[] array, int start, int length) { Same(length); }
        public void SetColors(Color32[] array, int start, int length) { Same(length); }
        public void SetTriangles(int[] array, int start, int length, int part, bool bounds, int first)
        {
            if (length % 3 != 0) throw new ArgumentException("no triangles");
            for (int i = start; i < start + length; i++)
                if (array[i] < 0 || array[i] >= vertices) throw new ArgumentException("a corner that is no vertex");
            triangles = length / 3;
            backwards = 0;
            for (int i = start; i < start + length; i += 3)
            {
                Vector3 a = points[array[i]], b = points[array[i + 1]], c = points[array[i + 2]], n = normals[array[i]];
                float ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
                float front = n.x * (uy * vz - uz * vy) + n.y * (uz * vx - ux * vz) + n.z * (ux * vy - uy * vx);
                backwards += front < 0 ? 1 : 0;
            }
        }
    }
}
