// What the extension needs of Godot's C interface, by names that say it. The interface itself, gdextension_interface.h, is
// the engine's: `godot --headless --dump-gdextension-interface` writes it.
#ifndef SINGE_GODOT_H
#define SINGE_GODOT_H

#include <gdextension_interface.h>

#include <stdbool.h>
#include <stdint.h>

/// Room for any value that passes between the engine and us: a number, a vector, a String, a Transform3D.
typedef union GodotValue {
    double real;
    int64_t whole;
    GDExtensionBool yes;
    float vector[16];
    int32_t cells[2];
    void *string; ///< the engine's String or StringName
    uint64_t rid;
    uint8_t bytes[64];
} GodotValue;

/// A class of the extension: what the engine calls. `self` is what create returned.
typedef struct GodotMethod {
    const char *name;
    void (*run)(void *self, const GodotValue *const *arguments, GodotValue *result);
    GDExtensionVariantType returns; ///< NIL: nothing
    int argument_count;
    const char *argument_names[4];
    GDExtensionVariantType arguments[4];
} GodotMethod;

/// A property, by the methods set_NAME and get_NAME.
typedef struct GodotProperty {
    const char *name;
    GDExtensionVariantType type;
} GodotProperty;

typedef struct GodotClass {
    const char *name, *parent;
    void *(*create)(void *object); ///< `object` is the engine's
    void (*destroy)(void *self);
    void (*process)(void *self, double seconds);    ///< once a frame
    void (*bounds)(const void *self, float box[6]); ///< position and size, in the node's axes
    const GodotMethod *methods;
    int method_count;
    const GodotProperty *properties;
    int property_count;
} GodotClass;

/// Fetches the interface. False where the engine lacks a part of it.
bool godot_begin(GDExtensionInterfaceGetProcAddress get, GDExtensionClassLibraryPtr library);
void godot_register(const GodotClass *class);
void godot_unregister(const GodotClass *class);

/// A method of the engine; NULL if it has none of this name and hash, which is then printed.
GDExtensionMethodBindPtr godot_method(const char *class, const char *method, int64_t hash);
/// Calls it; `object` NULL is the rendering server.
void godot_call(GDExtensionMethodBindPtr method, void *object, const void *const *arguments, void *result);

void godot_error(const char *what, const char *message);

/// Text of a String, at most size - 1 bytes.
void godot_text(const void *string, char *text, int size);
/// Makes a String; godot_string_free releases it.
GodotValue godot_string(const char *text);
void godot_string_free(GodotValue *string);
/// The path in the file system of one that may begin with res:// or user://.
void godot_path(const void *string, char *path, int size);

// ---- arrays of bytes that are made once and written in place

typedef struct GodotBytes {
    uint8_t packed[16]; ///< a PackedByteArray
    int64_t size;
    bool made;
} GodotBytes;

void godot_bytes_make(GodotBytes *bytes, int64_t size);
void godot_bytes_free(GodotBytes *bytes);
uint8_t *godot_bytes_data(GodotBytes *bytes);

// ---- the Dictionary of a surface, for RenderingServer.mesh_add_surface

typedef struct GodotSurface {
    int64_t format, vertex_count, index_count;
    GodotBytes *vertices, *attributes, *indices;
    float box[6]; ///< position and size
} GodotSurface;

void godot_add_surface(GDExtensionMethodBindPtr add, uint64_t mesh, const GodotSurface *surface);

#endif
