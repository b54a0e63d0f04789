// Godot's C interface: what is fetched once, and calls by it.
#include "godot.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Of the interface, by the names that it has there.
#define GODOT_FUNCTIONS(FUNCTION)                                                              \
    FUNCTION(StringNameNewWithLatin1Chars, string_name_new_with_latin1_chars)                  \
    FUNCTION(StringNewWithUtf8Chars, string_new_with_utf8_chars)                               \
    FUNCTION(StringToUtf8Chars, string_to_utf8_chars)                                          \
    FUNCTION(VariantGetPtrDestructor, variant_get_ptr_destructor)                              \
    FUNCTION(VariantGetPtrConstructor, variant_get_ptr_constructor)                            \
    FUNCTION(VariantGetPtrBuiltinMethod, variant_get_ptr_builtin_method)                       \
    FUNCTION(VariantGetPtrKeyedSetter, variant_get_ptr_keyed_setter)                           \
    FUNCTION(GetVariantFromTypeConstructor, get_variant_from_type_constructor)                 \
    FUNCTION(GetVariantToTypeConstructor, get_variant_to_type_constructor)                     \
    FUNCTION(VariantDestroy, variant_destroy)                                                  \
    FUNCTION(VariantGetType, variant_get_type)                                                 \
    FUNCTION(ClassdbGetMethodBind, classdb_get_method_bind)                                    \
    FUNCTION(ClassdbConstructObject2, classdb_construct_object2)                               \
    FUNCTION(ClassdbRegisterExtensionClass4, classdb_register_extension_class4)                \
    FUNCTION(ClassdbRegisterExtensionClassMethod, classdb_register_extension_class_method)     \
    FUNCTION(ClassdbRegisterExtensionClassProperty, classdb_register_extension_class_property) \
    FUNCTION(ClassdbUnregisterExtensionClass, classdb_unregister_extension_class)              \
    FUNCTION(ObjectSetInstance, object_set_instance)                                           \
    FUNCTION(ObjectMethodBindPtrcall, object_method_bind_ptrcall)                              \
    FUNCTION(GlobalGetSingleton, global_get_singleton)                                         \
    FUNCTION(PackedByteArrayOperatorIndex, packed_byte_array_operator_index)                   \
    FUNCTION(PrintErrorWithMessage, print_error_with_message)

/// The engine's side; the process has one engine, and it loads the extension once.
static struct {
    GDExtensionClassLibraryPtr library;
    void *rendering_server, *project_settings;
    GDExtensionMethodBindPtr notification, globalize;
    GDExtensionPtrDestructor string_free, name_free, bytes_free, dictionary_free;
#define FUNCTION(type, name) GDExtensionInterface##type name;
    GODOT_FUNCTIONS(FUNCTION)
#undef FUNCTION
} engine;

static GodotValue godot_name(const char *text) {
    GodotValue name = {0};
    engine.string_name_new_with_latin1_chars(&name, text, true);
    return name;
}

static void *godot_singleton(const char *name) {
    GodotValue key = godot_name(name);
    return engine.global_get_singleton(&key);
}

bool godot_begin(GDExtensionInterfaceGetProcAddress get, GDExtensionClassLibraryPtr library) {
    engine.library = library;
#define FUNCTION(type, name)                                              \
    engine.name = (GDExtensionInterface##type)(void (*)(void))get(#name); \
    if (!engine.name) return false;
    GODOT_FUNCTIONS(FUNCTION)
#undef FUNCTION
    engine.string_free = engine.variant_get_ptr_destructor(GDEXTENSION_VARIANT_TYPE_STRING);
    engine.name_free = engine.variant_get_ptr_destructor(GDEXTENSION_VARIANT_TYPE_STRING_NAME);
    engine.bytes_free = engine.variant_get_ptr_destructor(GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY);
    engine.dictionary_free = engine.variant_get_ptr_destructor(GDEXTENSION_VARIANT_TYPE_DICTIONARY);
    return true;
}

GDExtensionMethodBindPtr godot_method(const char *class, const char *method, int64_t hash) {
    GodotValue name = godot_name(class), key = godot_name(method);
    GDExtensionMethodBindPtr found = engine.classdb_get_method_bind(&name, &key, hash);
    if (!found) godot_error("this version of Godot lacks a method", method);
    return found;
}

void godot_call(GDExtensionMethodBindPtr method, void *object, const void *const *arguments, void *result) {
    if (!object && !engine.rendering_server) engine.rendering_server = godot_singleton("RenderingServer");
    engine.object_method_bind_ptrcall(method, object ? object : engine.rendering_server, arguments, result);
}

void godot_error(const char *what, const char *message) {
    engine.print_error_with_message(what, message, "SingeSheet", __FILE__, __LINE__, false);
}

// ---- text

void godot_text(const void *string, char *text, int size) {
    const int64_t length = engine.string_to_utf8_chars(string, text, size - 1);
    text[length < 0 ? 0 : length < size ? length : size - 1] = 0;
}

GodotValue godot_string(const char *text) {
    GodotValue string = {0};
    engine.string_new_with_utf8_chars(&string, text);
    return string;
}

void godot_string_free(GodotValue *string) { engine.string_free(string); }

void godot_path(const void *string, char *path, int size) {
    if (!engine.project_settings) {
        engine.project_settings = godot_singleton("ProjectSettings");
        engine.globalize = godot_method("ProjectSettings", "globalize_path", 3135753539);
    }
    GodotValue made = godot_string("");
    const void *arguments[] = {string};
    godot_call(engine.globalize, engine.project_settings, arguments, &made);
    godot_text(&made, path, size);
    godot_string_free(&made);
}

// ---- bytes

void godot_bytes_make(GodotBytes *bytes, int64_t size) {
    godot_bytes_free(bytes);
    GodotValue name = godot_name("resize"), result = {0};
    const void *arguments[] = {&size};
    engine.variant_get_ptr_constructor(GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY, 0)(bytes->packed, NULL);
    engine.variant_get_ptr_builtin_method(GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY, &name,
                                          848867239)(bytes->packed, arguments, &result, 1);
    bytes->size = size;
    bytes->made = true;
    if (size) memset(godot_bytes_data(bytes), 0, (size_t)size);
}

void godot_bytes_free(GodotBytes *bytes) {
    if (bytes->made) engine.bytes_free(bytes->packed);
    *bytes = (GodotBytes){0};
}

uint8_t *godot_bytes_data(GodotBytes *bytes) { return engine.packed_byte_array_operator_index(bytes->packed, 0); }

/// dictionary[name] = value
static void godot_set(void *dictionary, const char *name, GDExtensionVariantType type, void *value) {
    uint64_t key[3], variant[3];
    GodotValue text = godot_string(name);
    engine.get_variant_from_type_constructor(GDEXTENSION_VARIANT_TYPE_STRING)(key, &text);
    engine.get_variant_from_type_constructor(type)(variant, value);
    engine.variant_get_ptr_keyed_setter(GDEXTENSION_VARIANT_TYPE_DICTIONARY)(dictionary, key, variant);
    engine.variant_destroy(key);
    engine.variant_destroy(variant);
    godot_string_free(&text);
}

void godot_add_surface(GDExtensionMethodBindPtr add, uint64_t mesh, const GodotSurface *surface) {
    GodotValue made = {0};
    int64_t triangles = 3; // RenderingServer.PRIMITIVE_TRIANGLES
    GodotSurface all = *surface;
    engine.variant_get_ptr_constructor(GDEXTENSION_VARIANT_TYPE_DICTIONARY, 0)(&made, NULL);
    godot_set(&made, "primitive", GDEXTENSION_VARIANT_TYPE_INT, &triangles);
    godot_set(&made, "format", GDEXTENSION_VARIANT_TYPE_INT, &all.format);
    godot_set(&made, "vertex_count", GDEXTENSION_VARIANT_TYPE_INT, &all.vertex_count);
    godot_set(&made, "index_count", GDEXTENSION_VARIANT_TYPE_INT, &all.index_count);
    godot_set(&made, "vertex_data", GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY, all.vertices->packed);
    godot_set(&made, "attribute_data", GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY, all.attributes->packed);
    godot_set(&made, "index_data", GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY, all.indices->packed);
    godot_set(&made, "aabb", GDEXTENSION_VARIANT_TYPE_AABB, all.box);
    const void *arguments[] = {&mesh, &made};
    godot_call(add, NULL, arguments, NULL);
    engine.dictionary_free(&made);
}

// ---- a class

static GDExtensionObjectPtr class_create(void *data, GDExtensionBool notify) {
    const GodotClass *class = data;
    GodotValue parent = godot_name(class->parent), name = godot_name(class->name);
    GDExtensionObjectPtr object = engine.classdb_construct_object2(&parent);
    engine.object_set_instance(object, &name, class->create(object));
    if (notify) {
        int64_t what = 0; // NOTIFICATION_POSTINITIALIZE
        GDExtensionBool reversed = false;
        const void *arguments[] = {&what, &reversed};
        if (!engine.notification) engine.notification = godot_method("Object", "notification", 4023243586);
        godot_call(engine.notification, object, arguments, NULL);
    }
    return object;
}

static void class_destroy(void *data, GDExtensionClassInstancePtr self) { ((const GodotClass *)data)->destroy(self); }

/// The class of the extension, there is one: the engine gives no more than the instance to virtual functions.
static const GodotClass *registered;

static void class_process(GDExtensionClassInstancePtr self, const GDExtensionConstTypePtr *arguments,
                          GDExtensionTypePtr result) {
    (void)result;
    registered->process(self, *(const double *)arguments[0]);
}

static void class_bounds(GDExtensionClassInstancePtr self, const GDExtensionConstTypePtr *arguments,
                         GDExtensionTypePtr result) {
    (void)arguments;
    registered->bounds(self, result);
}

static GDExtensionClassCallVirtual class_virtual(void *data, GDExtensionConstStringNamePtr name, uint32_t hash) {
    (void)data, (void)hash;
    GodotValue process = godot_name("_process"), bounds = godot_name("_get_aabb");
    if (memcmp(name, &process, sizeof(void *)) == 0) return class_process;
    return memcmp(name, &bounds, sizeof(void *)) == 0 ? class_bounds : NULL;
}

static void method_pointers(void *data, GDExtensionClassInstancePtr self, const GDExtensionConstTypePtr *arguments,
                            GDExtensionTypePtr result) {
    ((const GodotMethod *)data)->run(self, (const GodotValue *const *)arguments, result);
}

static void method_variants(void *data, GDExtensionClassInstancePtr self, const GDExtensionConstVariantPtr *arguments,
                            GDExtensionInt count, GDExtensionVariantPtr result, GDExtensionCallError *error) {
    const GodotMethod *method = data;
    GodotValue values[4] = {0}, made = {0};
    const GodotValue *pointers[4] = {&values[0], &values[1], &values[2], &values[3]};
    *error = (GDExtensionCallError){0};
    if (count != method->argument_count) {
        error->error = count < method->argument_count ? GDEXTENSION_CALL_ERROR_TOO_FEW_ARGUMENTS
                                                      : GDEXTENSION_CALL_ERROR_TOO_MANY_ARGUMENTS;
        error->argument = error->expected = method->argument_count;
        return;
    }
    for (int i = 0; i < count; i++) {
        // an int serves where a float is expected
        const GDExtensionVariantType given = engine.variant_get_type(arguments[i]), wanted = method->arguments[i];
        const bool rounded = wanted == GDEXTENSION_VARIANT_TYPE_FLOAT && given == GDEXTENSION_VARIANT_TYPE_INT;
        if (given != wanted && !rounded) {
            error->error = GDEXTENSION_CALL_ERROR_INVALID_ARGUMENT;
            error->argument = i;
            error->expected = (int32_t)wanted;
            while (i-- > 0)
                if (method->arguments[i] == GDEXTENSION_VARIANT_TYPE_STRING) engine.string_free(&values[i]);
            return;
        }
        engine.get_variant_to_type_constructor(given)(&values[i], (GDExtensionVariantPtr)arguments[i]);
        if (rounded) values[i].real = (double)values[i].whole;
    }
    method->run(self, pointers, &made);
    for (int i = 0; i < count; i++)
        if (method->arguments[i] == GDEXTENSION_VARIANT_TYPE_STRING) engine.string_free(&values[i]);
    if (method->returns == GDEXTENSION_VARIANT_TYPE_NIL) return;
    engine.get_variant_from_type_constructor(method->returns)(result, &made);
    if (method->returns == GDEXTENSION_VARIANT_TYPE_STRING) engine.string_free(&made);
}

/// Kept by the engine only for the call that gets it.
static GDExtensionPropertyInfo property_info(GDExtensionVariantType type, GodotValue *name, GodotValue *empty) {
    return (GDExtensionPropertyInfo){.type = type,
                                     .name = name,
                                     .class_name = empty,
                                     .hint_string = empty + 1,
                                     .usage = 6}; // stored, and shown in the editor
}

static void register_method(const GodotClass *class, const GodotMethod *method, GodotValue *empty) {
    GodotValue owner = godot_name(class->name), name = godot_name(method->name), names[4];
    GDExtensionPropertyInfo arguments[4], result = property_info(method->returns, empty, empty);
    GDExtensionClassMethodArgumentMetadata plain[4] = {0};
    for (int i = 0; i < method->argument_count; i++) {
        names[i] = godot_name(method->argument_names[i]);
        arguments[i] = property_info(method->arguments[i], &names[i], empty);
    }
    GDExtensionClassMethodInfo info = {.name = &name,
                                       .method_userdata = (void *)method,
                                       .call_func = method_variants,
                                       .ptrcall_func = method_pointers,
                                       .method_flags = GDEXTENSION_METHOD_FLAGS_DEFAULT,
                                       .has_return_value = method->returns != GDEXTENSION_VARIANT_TYPE_NIL,
                                       .return_value_info = &result,
                                       .argument_count = (uint32_t)method->argument_count,
                                       .arguments_info = arguments,
                                       .arguments_metadata = plain};
    engine.classdb_register_extension_class_method(engine.library, &owner, &info);
}

void godot_register(const GodotClass *class) {
    registered = class;
    GodotValue name = godot_name(class->name), parent = godot_name(class->parent);
    GodotValue empty[2] = {godot_name(""), godot_string("")};
    GDExtensionClassCreationInfo4 info = {.is_exposed = true,
                                          .is_runtime = true,
                                          .create_instance_func = class_create,
                                          .free_instance_func = class_destroy,
                                          .get_virtual_func = class_virtual,
                                          .class_userdata = (void *)class};
    engine.classdb_register_extension_class4(engine.library, &name, &parent, &info);
    for (int i = 0; i < class->method_count; i++) register_method(class, &class->methods[i], empty);
    for (int i = 0; i < class->property_count; i++) {
        char text[2][64];
        snprintf(text[0], sizeof text[0], "set_%s", class->properties[i].name);
        snprintf(text[1], sizeof text[1], "get_%s", class->properties[i].name);
        GodotValue key = godot_name(class->properties[i].name), set = {0}, get = {0};
        engine.string_name_new_with_latin1_chars(&set, text[0], false); // copied: this text does not stay
        engine.string_name_new_with_latin1_chars(&get, text[1], false);
        GDExtensionPropertyInfo property = property_info(class->properties[i].type, &key, empty);
        engine.classdb_register_extension_class_property(engine.library, &name, &property, &set, &get);
        engine.name_free(&set);
        engine.name_free(&get);
    }
    godot_string_free(&empty[1]);
}

void godot_unregister(const GodotClass *class) {
    GodotValue name = godot_name(class->name);
    engine.classdb_unregister_extension_class(engine.library, &name);
}
