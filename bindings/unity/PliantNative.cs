// Made from include/pliant.h by bindings/generate.py. Units, frames, lifetimes and threads: there.
using System;
using System.Runtime.InteropServices;

namespace Pliant
{
    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_vec3
    {
        public double x;
        public double y;
        public double z;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_quat
    {
        public double x;
        public double y;
        public double z;
        public double w;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_pose
    {
        public pliant_vec3 position;
        public pliant_quat rotation;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_wrench
    {
        public pliant_vec3 force;
        public pliant_vec3 torque;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_path_row
    {
        public double time;
        public pliant_pose pose;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_range
    {
        public uint first;
        public uint count;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_error
    {
        public uint size;
        public int node;
        public IntPtr message;
        public IntPtr where;
        public IntPtr what;
        public IntPtr cure;
        public IntPtr code;
        public IntPtr pointer;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_load_options
    {
        public uint size;
        public double max_force;
        public IntPtr progress;
        public IntPtr user;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_mesh
    {
        public uint size;
        public uint vertex_count;
        public uint index_count;
        public IntPtr position;
        public IntPtr index;
        public IntPtr normal;
        public IntPtr uv;
        public IntPtr stiffness;
        public IntPtr friction;
        public IntPtr damping;
        public IntPtr relaxation;
        public IntPtr pinned;
        public IntPtr handle;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_placement
    {
        public uint size;
        public pliant_pose pose;
        public pliant_vec3 scale;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_slider
    {
        public uint size;
        public IntPtr @object;
        public IntPtr key;
        public IntPtr name;
        public IntPtr unit;
        public double low;
        public double high;
        public double step;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_reading
    {
        public uint size;
        public int ready;
        public int touching;
        public uint @object;
        public uint contacts;
        public ulong tick;
        public double time;
        public pliant_vec3 position;
        public pliant_vec3 force;
        public pliant_vec3 torque;
        public pliant_vec3 normal;
        public double depth;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_contact
    {
        public uint size;
        public int sliding;
        public uint @object;
        public uint triangle;
        public uint vertex;
        public pliant_vec3 position;
        public pliant_vec3 normal;
        public pliant_vec3 force;
        public double depth;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_contact_side
    {
        public uint @object;
        public uint effector;
        public uint triangle;
        public uint vertex;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_body_contact
    {
        public uint size;
        public int sliding;
        public pliant_contact_side a;
        public pliant_contact_side b;
        public pliant_vec3 position;
        public pliant_vec3 normal;
        public pliant_vec3 force;
        public double depth;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_handle_reading
    {
        public uint size;
        public IntPtr tool;
        public pliant_pose pose;
        public pliant_wrench wrench;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_event
    {
        public uint size;
        public int kind;
        public int index;
        public ulong tick;
        public double time;
        public IntPtr probe;
        public IntPtr @object;
        public IntPtr layer;
        public IntPtr sentence;
        public pliant_vec3 position;
        public double value;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_figures
    {
        public uint size;
        public ulong ticks;
        public double p50_us;
        public double p99_us;
        public double max_us;
        public ulong overruns;
        public ulong soft_steps;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_note
    {
        public uint size;
        public IntPtr message;
        public IntPtr code;
        public IntPtr of;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_geometry
    {
        public uint size;
        public uint vertex_count;
        public uint index_count;
        public IntPtr position;
        public IntPtr normal;
        public IntPtr shading_normal;
        public IntPtr uv;
        public IntPtr stream_vertex;
        public IntPtr index;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_query
    {
        public uint size;
        public int rest;
        public IntPtr @object;
        public double within;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_hit
    {
        public uint size;
        public int found;
        public uint @object;
        public uint triangle;
        public pliant_vec3 barycentric;
        public pliant_vec3 position;
        public pliant_vec3 normal;
        public double distance;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_device_info
    {
        public uint size;
        public int renders_force;
        public int renders_torque;
        public int senses_rotation;
        public IntPtr driver;
        public IntPtr id;
        public IntPtr name;
        public IntPtr missing;
        public double max_force;
        public double rate;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_guard
    {
        public uint size;
        public int by_hand;
        public uint dead_man;
        public double max_force;
        public double max_torque;
        public double max_velocity;
        public double slew;
        public double ramp;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_device_sample
    {
        public uint size;
        public int ready;
        public pliant_pose pose;
        public double grip;
        public double time;
        public double battery;
        public uint buttons;
        public uint warnings;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_device_report
    {
        public uint size;
        public int state;
        public IntPtr cause;
        public double force;
        public double max_force;
        public double heat;
        public double sample_age;
        public pliant_device_sample sample;
        public pliant_wrench wanted;
        public pliant_wrench sent;
        public ulong periods;
        public ulong missed;
        public double rate;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_driver
    {
        public uint size;
        public int senses_rotation;
        public int renders_force;
        public int renders_torque;
        public double max_force;
        public double max_torque;
        public double max_stiffness;
        public double max_velocity;
        public double rate;
        public IntPtr user;
        public IntPtr open;
        public IntPtr read;
        public IntPtr write;
        public IntPtr close;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct pliant_view
    {
        public uint size;
        public pliant_vec3 eye;
        public pliant_vec3 target;
        public pliant_vec3 up;
        public double yfov;
    }

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public delegate void pliant_log_function(IntPtr user, int level, IntPtr sentence);

    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public delegate int pliant_progress(IntPtr user, double share, IntPtr doing);

    public static class Native
    {
        const string Library = "pliant";

        public const int PLIANT_ABI_VERSION = 0;
        public const uint PLIANT_NONE = 0xffffffffu;
        public const int PLIANT_OK = 0;
        public const int PLIANT_FAILED = 1;
        public const int PLIANT_MISUSED = 2;
        public const int PLIANT_LOG_INFO = 0;
        public const int PLIANT_LOG_WARNING = 1;
        public const int PLIANT_LOG_FATAL = 2;
        public const int PLIANT_EVENT_BROKE = 0;
        public const int PLIANT_EVENT_YIELDED = 1;
        public const int PLIANT_EVENT_CROSSED = 2;
        public const int PLIANT_DEVICE_DISCONNECTED = 0;
        public const int PLIANT_DEVICE_IDLE = 1;
        public const int PLIANT_DEVICE_ARMED = 2;
        public const int PLIANT_DEVICE_ACTIVE = 3;
        public const int PLIANT_DEVICE_TRIPPED = 4;

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern IntPtr pliant_version();
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern uint pliant_abi_version();
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_last_error(ref pliant_error @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern IntPtr pliant_error_message();
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern IntPtr pliant_error_code();
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_set_log(pliant_log_function log, IntPtr user);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern void pliant_make_devices_safe();
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern void pliant_make_devices_safe_on_signals();
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_set_limit_factor(double factor);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_scene_load([MarshalAs(UnmanagedType.LPUTF8Str)] string path, pliant_load_options[] options, out IntPtr @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_scene_load_memory(byte[] bytes, ulong byte_count, [MarshalAs(UnmanagedType.LPUTF8Str)] string name, pliant_load_options[] options, out IntPtr @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_scene_create([MarshalAs(UnmanagedType.LPUTF8Str)] string name, out IntPtr @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_scene_destroy(IntPtr scene);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_scene_save(IntPtr scene, [MarshalAs(UnmanagedType.LPUTF8Str)] string path);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_scene_note_count(IntPtr scene, out ulong count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_scene_note(IntPtr scene, ulong index, out IntPtr @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_scene_add_surface(IntPtr scene, [MarshalAs(UnmanagedType.LPUTF8Str)] string name, ref pliant_mesh mesh, pliant_placement[] at);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_scene_add_soft_body(IntPtr scene, [MarshalAs(UnmanagedType.LPUTF8Str)] string name, ref pliant_mesh mesh, pliant_placement[] at);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_scene_add_rigid_body(IntPtr scene, [MarshalAs(UnmanagedType.LPUTF8Str)] string name, ref pliant_mesh mesh, pliant_placement[] at);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_scene_add_handle(IntPtr scene, [MarshalAs(UnmanagedType.LPUTF8Str)] string body);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_scene_add_probe(IntPtr scene, [MarshalAs(UnmanagedType.LPUTF8Str)] string name, pliant_placement[] at);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_scene_add_effect(IntPtr scene, [MarshalAs(UnmanagedType.LPUTF8Str)] string name, pliant_placement[] at, pliant_path_row[] rows, ulong count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_scene_add_joint(IntPtr scene, [MarshalAs(UnmanagedType.LPUTF8Str)] string name, [MarshalAs(UnmanagedType.LPUTF8Str)] string a, [MarshalAs(UnmanagedType.LPUTF8Str)] string b, pliant_placement[] at);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_scene_set(IntPtr scene, [MarshalAs(UnmanagedType.LPUTF8Str)] string assignment);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_open(IntPtr scene, pliant_progress progress, IntPtr user, out IntPtr @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_destroy(IntPtr session);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_effector_count(IntPtr session, out uint count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_effector(IntPtr session, uint index, out IntPtr @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_object_count(IntPtr session, out uint count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_object(IntPtr session, uint index, out IntPtr @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_note_count(IntPtr session, out ulong count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_note(IntPtr session, ulong index, out IntPtr @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_tick(IntPtr session, pliant_pose[] poses, [In, Out] pliant_wrench[] felt, ulong count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_step(IntPtr session, ulong ticks);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_start(IntPtr session);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_pause(IntPtr session, int paused);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_stop(IntPtr session);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_is_running(IntPtr session, out int @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_restart(IntPtr session);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_time(IntPtr session, out double seconds);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_move(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string effector, pliant_pose pose);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_follow(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string effector, pliant_path_row[] rows, ulong count, int repeats);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_orbit(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string effector);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_connect(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string effector, [MarshalAs(UnmanagedType.LPUTF8Str)] string driver);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_release(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string effector);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_set(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string @object, [MarshalAs(UnmanagedType.LPUTF8Str)] string key, double value);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_set_word(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string @object, [MarshalAs(UnmanagedType.LPUTF8Str)] string key, [MarshalAs(UnmanagedType.LPUTF8Str)] string word);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_set_values(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string @object, [MarshalAs(UnmanagedType.LPUTF8Str)] string key, double[] values, ulong count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_get(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string @object, [MarshalAs(UnmanagedType.LPUTF8Str)] string key, out double @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_slider_count(IntPtr session, out ulong count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_slider(IntPtr session, ulong index, ref pliant_slider @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_reading(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string effector, ref pliant_reading @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_contacts(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string effector, [In, Out] pliant_contact[] @out, ulong capacity, out ulong count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_body_contacts(IntPtr session, [In, Out] pliant_body_contact[] @out, ulong capacity, out ulong count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_handles(IntPtr session, [In, Out] pliant_handle_reading[] @out, ulong capacity, out ulong count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_take_events(IntPtr session, [In, Out] pliant_event[] @out, ulong capacity, out ulong count, out ulong lost);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_keep_readings(IntPtr session, ulong ticks);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_take_readings(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string effector, [In, Out] pliant_reading[] @out, ulong capacity, out ulong count, out ulong lost);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_figures(IntPtr session, ref pliant_figures @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_find(IntPtr session, out ulong count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_finding(IntPtr session, ulong index, ref pliant_note @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_vertices(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string @object, [In, Out] float[] @out, ulong capacity, out ulong count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_normals(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string @object, [In, Out] float[] @out, ulong capacity, out ulong count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_vertex_forces(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string @object, [In, Out] float[] @out, ulong capacity, out ulong count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_triangles(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string @object, [In, Out] uint[] @out, ulong capacity, out ulong count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_geometry(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string @object, ref pliant_geometry @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_stream(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string @object, out IntPtr stream, out ulong count, out IntPtr changed, out ulong changed_count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_to_world(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string @object, [In, Out] float[] @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_closest_point(IntPtr session, pliant_vec3 point, pliant_query[] query, ref pliant_hit @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_ray(IntPtr session, pliant_vec3 from, pliant_vec3 direction, pliant_query[] query, ref pliant_hit @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_bounds(IntPtr session, pliant_query[] query, out pliant_vec3 min, out pliant_vec3 max);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_set_hand_force(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string effector, pliant_wrench wrench);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_set_body_force(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string body, pliant_wrench wrench);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_set_point_force(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string body, uint vertex, pliant_vec3 force);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_push(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string body, pliant_wrench impulse);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_push_at(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string body, uint vertex, pliant_vec3 impulse);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_place(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string @object, pliant_pose pose);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_take_out(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string @object);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_put_back(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string @object);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_is_out(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string @object, out int @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_add(IntPtr session, IntPtr more);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_save_state(IntPtr session, out IntPtr bytes, out ulong count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_restore_state(IntPtr session, byte[] bytes, ulong count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_record(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string path, int replace);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_end_recording(IntPtr session);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_replay(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string path);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_export_recording([MarshalAs(UnmanagedType.LPUTF8Str)] string recording, [MarshalAs(UnmanagedType.LPUTF8Str)] string csv);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_register_all_drivers();
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_list_devices(out ulong count);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_device(ulong index, ref pliant_device_info @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_guard(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string effector, ref pliant_guard guard);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_device_report(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string effector, ref pliant_device_report @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_arm(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string effector);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_disarm(IntPtr session, [MarshalAs(UnmanagedType.LPUTF8Str)] string effector);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_session_emergency_stop(IntPtr session);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_register_driver([MarshalAs(UnmanagedType.LPUTF8Str)] string name, ref pliant_driver driver);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_pictures_headless(IntPtr session, out IntPtr @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_pictures_in_current_context(IntPtr session, out IntPtr @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_pictures_destroy(IntPtr pictures);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_pictures_view(IntPtr pictures, ref pliant_view @out);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_pictures_picture(IntPtr pictures, ref pliant_view view, int width, int height, [In, Out] byte[] rgba, ulong room);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_pictures_draw(IntPtr pictures, ref pliant_view view, uint framebuffer, int width, int height);
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern int pliant_pictures_draw_texture(IntPtr pictures, ref pliant_view view, uint texture, int width, int height);
    }
}
