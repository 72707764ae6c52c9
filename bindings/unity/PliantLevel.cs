// A level that is touched, as a Unity component: a Transform moves the first probe, a Mesh shows an object as it is
// dented, Force is felt. Put libpliant.so into Assets/Plugins/x86_64, PliantNative.cs and this file into Assets, the
// level into Assets/StreamingAssets; add this component to an object with a MeshFilter and a MeshRenderer.
using System;
using System.IO;
using System.Runtime.InteropServices;
using UnityEngine;

namespace Pliant
{
    // An error of the library: its sentence, and the code that a program goes by.
    public sealed class PliantException : Exception
    {
        public readonly string Code;
        public PliantException(string sentence, string code) : base(sentence) { Code = code; }

        // Throws unless a call has succeeded. On the calling thread, at once.
        public static void Check(int status)
        {
            if (status != Native.PLIANT_OK)
                throw new PliantException(Text(Native.pliant_error_message()), Text(Native.pliant_error_code()));
        }
        // UTF-8 of the library's.
        public static string Text(IntPtr at)
        {
            int length = 0;
            while (Marshal.ReadByte(at, length) != 0) ++length;
            var bytes = new byte[length];
            Marshal.Copy(at, bytes, 0, length);
            return System.Text.Encoding.UTF8.GetString(bytes);
        }
    }

    public sealed class PliantLevel : MonoBehaviour
    {
        public string level = "organ.glb";  // in StreamingAssets, or a path
        public string shown = "";           // object in the mesh; empty: the first
        public Transform probe;             // moves the first probe; null: this one
        public string device = "";          // driver that moves it instead, e.g. "inverse3"; empty: `probe`

        public Vector3 Force { get; private set; }  // [N] on the hand, Unity's frame
        public bool Touching { get; private set; }

        IntPtr scene, session;
        string effector;
        Mesh mesh;
        float[] positions, normals;
        Vector3[] meshPositions, meshNormals;

        // Pliant's frame is right-handed, Unity's left-handed: z changes sign.
        public static Vector3 ToUnity(pliant_vec3 v) { return new Vector3((float)v.x, (float)v.y, -(float)v.z); }
        public static pliant_pose ToPliant(Vector3 p, Quaternion q)
        {
            return new pliant_pose {
                position = new pliant_vec3 { x = p.x, y = p.y, z = -p.z },
                rotation = new pliant_quat { x = -q.x, y = -q.y, z = q.z, w = q.w }
            };
        }

        void OnEnable()
        {
            try { Open(); }
            catch (PliantException error) { Close(); Debug.LogError(error.Message); enabled = false; }
        }

        void Open()
        {
            if (Native.pliant_abi_version() != Native.PLIANT_ABI_VERSION)
                throw new PliantException("libpliant.so and PliantNative.cs are of different versions", "");
            PliantException.Check(Native.pliant_scene_load(Path.Combine(Application.streamingAssetsPath, level), null, out scene));
            PliantException.Check(Native.pliant_session_open(scene, null, IntPtr.Zero, out session));
            IntPtr name;
            PliantException.Check(Native.pliant_session_effector(session, 0, out name));
            effector = PliantException.Text(name);
            if (shown == "")
            {
                PliantException.Check(Native.pliant_session_object(session, 0, out name));
                shown = PliantException.Text(name);
            }
            MakeMesh();
            if (device != "")
            {
                PliantException.Check(Native.pliant_register_all_drivers());
                PliantException.Check(Native.pliant_session_connect(session, effector, device));
            }
            else Move();  // the first pose must be there before the clocks run
            PliantException.Check(Native.pliant_session_start(session));
        }

        void MakeMesh()
        {
            ulong vertices, indices;
            PliantException.Check(Native.pliant_session_vertices(session, shown, null, 0, out vertices));
            PliantException.Check(Native.pliant_session_triangles(session, shown, null, 0, out indices));
            var triangles = new uint[indices];
            PliantException.Check(Native.pliant_session_triangles(session, shown, triangles, indices, out indices));
            var turned = new int[indices];  // in a mirrored frame a triangle runs the other way round
            for (int i = 0; i < turned.Length; ++i) turned[i] = (int)triangles[i / 3 * 3 + 2 - i % 3];
            positions = new float[3 * vertices];
            normals = new float[3 * vertices];
            meshPositions = new Vector3[vertices];
            meshNormals = new Vector3[vertices];
            mesh = new Mesh { indexFormat = UnityEngine.Rendering.IndexFormat.UInt32 };
            mesh.MarkDynamic();
            ReadVertices();
            mesh.triangles = turned;
            GetComponent<MeshFilter>().mesh = mesh;
        }

        void Update()
        {
            if (session == IntPtr.Zero) return;
            if (device == "") Move();
            var reading = new pliant_reading { size = (uint)Marshal.SizeOf(typeof(pliant_reading)) };
            PliantException.Check(Native.pliant_session_reading(session, effector, ref reading));
            Force = ToUnity(reading.force);
            Touching = reading.touching != 0;
            ReadVertices();
        }

        void Move()
        {
            var hand = probe != null ? probe : transform;
            PliantException.Check(Native.pliant_session_move(session, effector, ToPliant(hand.position, hand.rotation)));
        }

        void ReadVertices()
        {
            ulong count, room = (ulong)meshPositions.Length;
            PliantException.Check(Native.pliant_session_vertices(session, shown, positions, room, out count));
            PliantException.Check(Native.pliant_session_normals(session, shown, normals, room, out count));
            for (int i = 0; i < meshPositions.Length; ++i)
            {
                meshPositions[i] = new Vector3(positions[3 * i], positions[3 * i + 1], -positions[3 * i + 2]);
                meshNormals[i] = new Vector3(normals[3 * i], normals[3 * i + 1], -normals[3 * i + 2]);
            }
            mesh.vertices = meshPositions;
            mesh.normals = meshNormals;
        }

        void OnDisable() { Close(); }

        // The force of a device is zero before this returns.
        void Close()
        {
            Native.pliant_session_destroy(session);
            Native.pliant_scene_destroy(scene);
            session = scene = IntPtr.Zero;
        }
    }
}
