// Prints layout.ts, what JavaScript has to know of the public headers: where fields lie in their structs, and the words of
// enums. The npm package calls the library's own functions with pointers. This program is compiled as the library is, and
// node runs it when the package is built (layout.mjs).
#include <singe/singe.h>

#include <stddef.h>
#include <stdio.h>
#include <string.h>

// ---- what is printed

static void print_field(const char *name, const char *type, size_t length, size_t offset, const char *words) {
    printf("            \"%s\": [\"%s\", %zu, %zu", name, type, length, offset);
    if (words) printf(", \"%s\"", words);
    puts("],");
}

static void print_array(const char *name, const char *type, size_t width, size_t offset, const char *count) {
    printf("            \"%s\": [\"%s\", %zu, %zu, \"%s\"],\n", name, type, width, offset, count);
}

static void print_word(const char *of, const char *word, int value) {
    static const char *last = "";
    if (!*word) return;
    if (strcmp(of, last) != 0) printf("%s    %s: {\n", *last ? "    },\n" : "", of);
    printf("        \"%s\": %d,\n", word, value);
    last = of;
}

/// The type of a field's numbers. An array is the address of its first one here. All else is the word of a pointer:
/// pointers of Defs are to what is const.
#define TYPE(field) \
    _Generic((field), float: "float", float *: "float", double: "double", int: "int", bool: "bool",       \
             uint64_t: "uint64", SingeParam: "param", SingeParam *: "param", default: "uint32")

/// Bytes of one of a field's numbers.
#define ELEMENT(field) \
    _Generic((field), float *: sizeof(float), uint32_t *: sizeof(uint32_t), SingeParam *: sizeof(SingeParam), \
             default: sizeof(field))

/// The type of what a pointer points to, or of the elements of an array that it points to.
#define TARGET(pointer) \
    _Generic(*(pointer), int32_t: "int", uint8_t: "uint8", uint32_t: "uint32", uint32_t *: "uint32",      \
             const uint32_t *: "uint32", default: "float")

// ---- rows of a struct, whose type is Struct where they stand

#define IN(name) (((Struct *)NULL)->name)
#define BEGIN(name, type) \
    typedef type Struct;  \
    printf("    %s: {\n        size: %zu,\n        fields: {\n", name, sizeof(Struct))
#define WORDS(name, words) \
    print_field(#name, TYPE(IN(name)), sizeof IN(name) / ELEMENT(IN(name)), offsetof(Struct, name), words)
#define FIELD(name) WORDS(name, NULL)
#define ARRAYS puts("        },\n        arrays: {")
#define COUNTED(name, width, count) print_array(#name, TARGET(IN(name)), width, offsetof(Struct, name), count)
#define ARRAY(name, width, count) COUNTED(name, width, #count)
#define END puts("        },\n    },")
#define STRUCT(name, type, ...) \
    do {                        \
        BEGIN(name, type);      \
        __VA_ARGS__;            \
        END;                    \
    } while (0)

// rows of the tables, by the words of their types
#define FLOAT NULL
#define VECTOR NULL
#define INT NULL
#define UINT32 NULL
#define UINT64 NULL
#define BOOL NULL
#define ORDER "SingeColour"
#define ENUM(name) #name
#define KIND ENUM

#define SINGE_ROWS_STAY
#define SINGE_FIELD(type, name, length, dimension, standard, range, kinds, text) WORDS(name, type);
#define SINGE_APART(key, type, name, length, dimension, standard, range, kinds, text) WORDS(name, type);
#define SINGE_HIDDEN SINGE_FIELD
#define SINGE_HOOK SINGE_FIELD
#define SINGE_COUNT(name, text) FIELD(name);
#define SINGE_OTHER(declaration, name, standard, text) FIELD(name);

/// Those that JavaScript fills in. The tables name all of their fields but struct_size.
static void print_defs(void) {
    {
        BEGIN("sim", SingeSimDef);
#include "singe/sim.def"
        END;
    }
    {
        BEGIN("wind", SingeWindDef);
#include "singe/wind.def"
        END;
    }
    {
        BEGIN("solver", SingeSolverDef);
#include "singe/solver.def"
        END;
    }
    {
        BEGIN("gas", SingeGasDef);
#include "singe/gas.def"
        END;
    }
    {
        BEGIN("contact", SingeContactDef);
#include "singe/contact.def"
        END;
    }
    {
        BEGIN("sheet", SingeSheetDef);
#include "singe/sheet.def"
        END;
    }
    {
        BEGIN("source", SingeSourceDef);
#include "singe/source.def"
        END;
    }
    {
        BEGIN("collider", SingeColliderDef);
#include "singe/collider.def"
        END;
    }
    {
        BEGIN("pin", SingePinDef);
#include "singe/pin.def"
        END;
    }
    {
        BEGIN("material", SingeMaterialDef);
        FIELD(struct_size);
#define SINGE_PARAM(number, NAME, name, dimension, standard, range, where, field, text) FIELD(name);
#define SINGE_PARAM_BACK SINGE_PARAM
#define SINGE_PARAM_COLOURS(number, NAME, name, range, text) FIELD(name);
#define SINGE_SCALAR(type, name, dimension, standard, range, text) WORDS(name, type);
#include "singe/material.def"
        END;
    }
    STRUCT("param", SingeParam, (void)0);
    STRUCT("field", SingeField, FIELD(kind), FIELD(texture), FIELD(noise.scale), FIELD(noise.octaves),
           FIELD(noise.seed));
    STRUCT("texture", SingeTexture, FIELD(width), FIELD(height), FIELD(values));
    STRUCT("grid", SingeGridDef, FIELD(size), FIELD(cells), FIELD(jitter), FIELD(displacement), FIELD(seed));
}

/// Those that the library fills in.
static void print_answers(void) {
    STRUCT("error", SingeError, FIELD(code), FIELD(stage), FIELD(element), FIELD(message));
    STRUCT("stats", SingeStats, FIELD(time), FIELD(particles), FIELD(springs), FIELD(cells), FIELD(pieces), FIELD(mass),
           FIELD(mass_initial), FIELD(mass_burnt), FIELD(mass_removed), FIELD(burnt_fraction), FIELD(temperature_max),
           FIELD(heat_in), FIELD(heat_lost), FIELD(heat_of_combustion), FIELD(heat_stored), FIELD(ledger_error),
           FIELD(mass_ledger_error), FIELD(strain_mean), FIELD(strain_p99), FIELD(strain_max), FIELD(front_speed),
           FIELD(tears), FIELD(ledgers_close), FIELD(arrival_error), FIELD(arrival_missed), FIELD(pace), FIELD(water));
    STRUCT("event", SingeEvent, FIELD(kind), FIELD(element), FIELD(time), FIELD(position));
    STRUCT("counts", SingeCounts, FIELD(particles), FIELD(cells), FIELD(springs), FIELD(cell_size), FIELD(memory),
           WORDS(instructions, "SingeInstructions"));
}

/// Those that point to arrays.
static void print_views(void) {
    STRUCT("view", SingeView, FIELD(time), FIELD(step), FIELD(topology_version), FIELD(particle_count),
           FIELD(vertex_count), FIELD(cell_count), FIELD(spring_count), ARRAYS, ARRAY(position, 4, particle_count),
           ARRAY(velocity, 4, particle_count), ARRAY(rest_position, 4, particle_count), ARRAY(uv, 2, particle_count),
           ARRAY(mass, 1, particle_count), ARRAY(temperature, 1, particle_count), ARRAY(burn_rate, 1, particle_count),
           ARRAY(time_ignited, 1, particle_count), ARRAY(piece, 1, particle_count),
           ARRAY(particle_flags, 1, particle_count), ARRAY(cell_flags, 1, cell_count), ARRAY(cells, 4, cell_count));
    STRUCT("surface", SingeSurface, FIELD(vertex_count), FIELD(triangle_count), ARRAYS,
           ARRAY(position, 3, vertex_count), ARRAY(normal, 3, vertex_count), ARRAY(uv, 2, vertex_count),
           ARRAY(velocity, 3, vertex_count), ARRAY(rest_position, 3, vertex_count), ARRAY(temperature, 1, vertex_count),
           ARRAY(temperature_peak, 1, vertex_count), ARRAY(mass, 1, vertex_count), ARRAY(burn_rate, 1, vertex_count),
           ARRAY(char_fraction, 1, vertex_count), ARRAY(ash_fraction, 1, vertex_count), ARRAY(burn, 1, vertex_count),
           ARRAY(time_ignited, 1, vertex_count), ARRAY(piece, 1, vertex_count), ARRAY(source_vertex, 1, vertex_count),
           ARRAY(sheet, 1, vertex_count), ARRAY(triangles, 3, triangle_count));
    STRUCT("air", SingeGas, FIELD(size), FIELD(origin), FIELD(cell), ARRAYS, COUNTED(temperature, 1, ""),
           COUNTED(smoke, 1, ""), COUNTED(flame, 1, ""), COUNTED(velocity, 3, ""));
    STRUCT("meshview", SingeMeshView, FIELD(vertex_count), FIELD(cell_count), ARRAYS, ARRAY(positions, 3, vertex_count),
           ARRAY(cells, 4, cell_count), ARRAY(uv, 2, vertex_count), ARRAY(corner_uv, 8, cell_count));
}
#undef SINGE_ROWS_STAY
#include "singe/rows_end.def"

/// Words of enums, from the tables that have some.
static void print_words(void) {
#define SINGE_ROWS_STAY
#define SINGE_WORD(Enum, NAME, value, word, text) print_word(#Enum, word, value);
#include "singe/source.def"
#include "singe/collider.def"
#include "singe/solver.def"
#include "singe/sim.def"
#include "singe/material.def"
#undef SINGE_ROWS_STAY
#include "singe/rows_end.def"
    puts("    },");
}

int main(void) {
    puts("// Made by layout.c: do not edit.\nimport type { Layout } from \"./memory.js\";\n");
    puts("export const layout: Layout = { structs: {");
    print_defs();
    print_answers();
    print_views();
    puts("}, words: {");
    print_words();
    puts("} };");
    return 0;
}
