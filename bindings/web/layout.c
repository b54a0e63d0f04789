// What JavaScript has to know of the public headers: where fields lie in their structs, and the words of enums. The npm
// package calls the library's own functions with pointers; it reads these lists once, when the module is loaded.
#include <singe/singe.h>

#include <stddef.h>

enum {
    LAYOUT_FLOAT,
    LAYOUT_INT,
    LAYOUT_UINT32,
    LAYOUT_UINT64,
    LAYOUT_BOOL,
    LAYOUT_PARAM,
    LAYOUT_DOUBLE,
    LAYOUT_INT32,
    LAYOUT_UINT8
};

/// A field of a struct. All members have four bytes.
typedef struct LayoutField {
    const char *of, *name;
    const char *words; ///< the enum whose words name its values, or NULL
    int type, length;
    size_t offset;
} LayoutField;

/// A pointer in a struct, to an array of `width` numbers for each element.
typedef struct LayoutArray {
    const char *of, *name;
    int type, width;
    size_t offset;
    size_t count; ///< offset of the number of elements; 0: the reader knows it
} LayoutArray;

typedef struct LayoutWord {
    const char *of, *word;
    int value;
} LayoutWord;

typedef struct LayoutStruct {
    const char *name;
    size_t size;
} LayoutStruct;

// ---- fields

#define FLOAT NULL, LAYOUT_FLOAT
#define VECTOR FLOAT
#define INT NULL, LAYOUT_INT
#define UINT32 NULL, LAYOUT_UINT32
#define UINT64 NULL, LAYOUT_UINT64
#define DOUBLE NULL, LAYOUT_DOUBLE
#define BOOL NULL, LAYOUT_BOOL
#define ORDER "SingeColour", LAYOUT_INT
#define ENUM(name) #name, LAYOUT_INT
#define KIND ENUM
#define FIELD(name, length, ...) \
    { STRUCT_NAME, #name, __VA_ARGS__, length, offsetof(STRUCT, name) }
#define PART(name) FIELD(name, 1, UINT32)

#define SINGE_ROWS_STAY
#define SINGE_FIELD(type, name, length, dimension, standard, range, kinds, text) FIELD(name, length, type),
#define SINGE_APART(key, type, name, length, dimension, standard, range, kinds, text) FIELD(name, length, type),
#define SINGE_HIDDEN SINGE_FIELD
#define SINGE_HOOK SINGE_FIELD
#define SINGE_COUNT(name, text) PART(name),

static const LayoutField fields[] = {
#define STRUCT SingeSimDef
#define STRUCT_NAME "sim"
#include "singe/sim.def"
    PART(struct_size),
    PART(wind),
    PART(solver),
    PART(gas),
    PART(contact),
    PART(log),
#undef STRUCT
#undef STRUCT_NAME
#define STRUCT SingeWindDef
#define STRUCT_NAME "wind"
#include "singe/wind.def"
#undef STRUCT
#undef STRUCT_NAME
#define STRUCT SingeSolverDef
#define STRUCT_NAME "solver"
#include "singe/solver.def"
#undef STRUCT
#undef STRUCT_NAME
#define STRUCT SingeGasDef
#define STRUCT_NAME "gas"
#include "singe/gas.def"
#undef STRUCT
#undef STRUCT_NAME
#define STRUCT SingeContactDef
#define STRUCT_NAME "contact"
#include "singe/contact.def"
#undef STRUCT
#undef STRUCT_NAME
#define STRUCT SingeSheetDef
#define STRUCT_NAME "sheet"
#include "singe/sheet.def"
    PART(material),
    PART(vertex_count),
    PART(positions),
    PART(cell_count),
    PART(cells),
    PART(uv),
    PART(corner_uv),
    PART(source_vertex),
    PART(source_count),
    PART(corner_source_vertex),
#undef STRUCT
#undef STRUCT_NAME
#define STRUCT SingeSourceDef
#define STRUCT_NAME "source"
#include "singe/source.def"
    FIELD(position, 3, FLOAT),
    PART(path),
    PART(texture),
#undef STRUCT
#undef STRUCT_NAME
#define STRUCT SingeColliderDef
#define STRUCT_NAME "collider"
#include "singe/collider.def"
    FIELD(position, 3, FLOAT),
    FIELD(rotation, 4, FLOAT),
    PART(path),
    PART(vertices),
    PART(vertex_count),
    PART(triangles),
    PART(triangle_count),
#undef STRUCT
#undef STRUCT_NAME
#define STRUCT SingePinDef
#define STRUCT_NAME "pin"
#include "singe/pin.def"
    PART(sheet),
    PART(point_count),
    PART(points),
    PART(vertex_count),
    PART(vertices),
    PART(path_count),
    PART(path),
#undef STRUCT
#undef STRUCT_NAME
#define STRUCT SingeMaterialDef
#define STRUCT_NAME "material"
#define SINGE_PARAM(number, NAME, name, dimension, standard, range, where, field, text) \
    {"material", #name, NULL, LAYOUT_PARAM, 1, offsetof(SingeMaterialDef, name)},
#define SINGE_PARAM_BACK SINGE_PARAM
#define SINGE_PARAM_COLOURS(number, NAME, name, range, text) \
    {"material", #name, NULL, LAYOUT_PARAM, 4, offsetof(SingeMaterialDef, name)},
#define SINGE_SCALAR(type, name, dimension, standard, range, text) FIELD(name, 1, type),
#include "singe/material.def"
    PART(struct_size),
#undef STRUCT
#undef STRUCT_NAME
#define STRUCT SingeField
#define STRUCT_NAME "field"
    PART(kind),
    PART(texture),
    PART(attribute),
    FIELD(noise.scale, 1, FLOAT),
    FIELD(noise.octaves, 1, INT),
    FIELD(noise.seed, 1, UINT32),
#undef STRUCT
#undef STRUCT_NAME
#define STRUCT SingeTexture
#define STRUCT_NAME "texture"
    FIELD(width, 1, INT),
    FIELD(height, 1, INT),
    PART(values),
#undef STRUCT
#undef STRUCT_NAME
#define STRUCT SingeGridDef
#define STRUCT_NAME "grid"
    FIELD(size, 2, FLOAT),
    FIELD(cells, 2, UINT32),
    FIELD(jitter, 1, FLOAT),
    FIELD(displacement, 1, FLOAT),
    FIELD(seed, 1, UINT32),
#undef STRUCT
#undef STRUCT_NAME
#define STRUCT SingeError
#define STRUCT_NAME "error"
    FIELD(code, 1, INT),
    PART(stage),
    PART(element),
    PART(message),
#undef STRUCT
#undef STRUCT_NAME
#define STRUCT SingeView
#define STRUCT_NAME "view"
    FIELD(time, 1, DOUBLE),
    FIELD(step, 1, UINT64),
    FIELD(topology_version, 1, UINT64),
    FIELD(particle_count, 1, UINT32),
    FIELD(vertex_count, 1, UINT32),
    FIELD(cell_count, 1, UINT32),
    FIELD(spring_count, 4, UINT32),
#undef STRUCT
#undef STRUCT_NAME
#define STRUCT SingeSurface
#define STRUCT_NAME "surface"
    FIELD(vertex_count, 1, UINT32),
    FIELD(triangle_count, 1, UINT32),
#undef STRUCT
#undef STRUCT_NAME
#define STRUCT SingeGas
#define STRUCT_NAME "air"
    FIELD(size, 3, UINT32),
    FIELD(origin, 3, FLOAT),
    FIELD(cell, 1, FLOAT),
#undef STRUCT
#undef STRUCT_NAME
#define STRUCT SingeStats
#define STRUCT_NAME "stats"
    FIELD(time, 1, DOUBLE),
    FIELD(particles, 1, UINT32),
    FIELD(springs, 1, UINT32),
    FIELD(cells, 1, UINT32),
    FIELD(pieces, 1, UINT32),
    FIELD(mass, 1, DOUBLE),
    FIELD(mass_initial, 1, DOUBLE),
    FIELD(mass_burnt, 1, DOUBLE),
    FIELD(mass_removed, 1, DOUBLE),
    FIELD(burnt_fraction, 1, DOUBLE),
    FIELD(temperature_max, 1, FLOAT),
    FIELD(heat_in, 1, DOUBLE),
    FIELD(heat_lost, 1, DOUBLE),
    FIELD(heat_of_combustion, 1, DOUBLE),
    FIELD(heat_stored, 1, DOUBLE),
    FIELD(ledger_error, 1, DOUBLE),
    FIELD(mass_ledger_error, 1, DOUBLE),
    FIELD(strain_mean, 1, DOUBLE),
    FIELD(strain_p99, 1, DOUBLE),
    FIELD(strain_max, 1, DOUBLE),
    FIELD(front_speed, 1, DOUBLE),
    FIELD(tears, 1, UINT32),
    FIELD(ledgers_close, 1, BOOL),
    FIELD(arrival_error, 1, DOUBLE),
    FIELD(arrival_missed, 1, UINT32),
    FIELD(pace, 1, FLOAT),
    FIELD(water, 1, DOUBLE),
#undef STRUCT
#undef STRUCT_NAME
#define STRUCT SingeEvent
#define STRUCT_NAME "event"
    FIELD(kind, 1, INT),
    FIELD(element, 1, INT),
    FIELD(time, 1, DOUBLE),
    FIELD(position, 3, FLOAT),
#undef STRUCT
#undef STRUCT_NAME
#define STRUCT SingeCounts
#define STRUCT_NAME "counts"
    FIELD(particles, 1, UINT32),
    FIELD(cells, 1, UINT32),
    FIELD(springs, 4, UINT32),
    FIELD(cell_size, 1, FLOAT),
    FIELD(memory, 1, UINT32),
    FIELD(instructions, 1, ENUM(SingeInstructions)),
};
#undef SINGE_ROWS_STAY
#include "singe/rows_end.def"

// ---- arrays

#define VIEW(type, name, width, count) \
    {"view", #name, LAYOUT_##type, width, offsetof(SingeView, name), offsetof(SingeView, count)},
#define SURFACE(type, name, width) \
    {"surface", #name, LAYOUT_##type, width, offsetof(SingeSurface, name), offsetof(SingeSurface, vertex_count)},
#define MESH(type, name, width, count) \
    {"meshview", #name, LAYOUT_##type, width, offsetof(SingeMeshView, name), offsetof(SingeMeshView, count)},
#define AIR(name, width) {"air", #name, LAYOUT_FLOAT, width, offsetof(SingeGas, name), 0},

static const LayoutArray arrays[] = {
    VIEW(FLOAT, position, 4, particle_count)       //
    VIEW(FLOAT, velocity, 4, particle_count)       //
    VIEW(FLOAT, rest_position, 4, particle_count)  //
    VIEW(FLOAT, uv, 2, particle_count)             //
    VIEW(FLOAT, mass, 1, particle_count)           //
    VIEW(FLOAT, temperature, 1, particle_count)    //
    VIEW(FLOAT, burn_rate, 1, particle_count)      //
    VIEW(FLOAT, time_ignited, 1, particle_count)   //
    VIEW(INT32, piece, 1, particle_count)          //
    VIEW(UINT8, particle_flags, 1, particle_count) //
    VIEW(UINT8, cell_flags, 1, cell_count)         //
    VIEW(UINT32, cells, 4, cell_count)             //
    SURFACE(FLOAT, position, 3)                    //
    SURFACE(FLOAT, normal, 3)                      //
    SURFACE(FLOAT, uv, 2)                          //
    SURFACE(FLOAT, velocity, 3)                    //
    SURFACE(FLOAT, rest_position, 3)               //
    SURFACE(FLOAT, temperature, 1)                 //
    SURFACE(FLOAT, temperature_peak, 1)            //
    SURFACE(FLOAT, mass, 1)                        //
    SURFACE(FLOAT, burn_rate, 1)                   //
    SURFACE(FLOAT, char_fraction, 1)               //
    SURFACE(FLOAT, ash_fraction, 1)                //
    SURFACE(FLOAT, burn, 1)                        //
    SURFACE(FLOAT, time_ignited, 1)                //
    SURFACE(INT32, piece, 1)                       //
    SURFACE(INT32, source_vertex, 1)               //
    SURFACE(INT32, sheet, 1)                       //
    {"surface", "triangles", LAYOUT_UINT32, 3, offsetof(SingeSurface, triangles),
     offsetof(SingeSurface, triangle_count)},
    AIR(temperature, 1) AIR(smoke, 1) AIR(flame, 1) AIR(velocity, 3) //
    MESH(FLOAT, positions, 3, vertex_count)                          //
    MESH(UINT32, cells, 4, cell_count)                               //
    MESH(FLOAT, uv, 2, vertex_count)                                 //
    MESH(FLOAT, corner_uv, 8, cell_count)                            //
};

// ---- words and sizes

#define SINGE_ROWS_STAY
#define SINGE_WORD(Enum, NAME, value, word, text) {#Enum, word, value},
static const LayoutWord words[] = {
#include "singe/source.def"
#include "singe/collider.def"
#include "singe/solver.def"
#include "singe/sim.def"
#include "singe/material.def"
};
#undef SINGE_ROWS_STAY
#include "singe/rows_end.def"

#define SIZE(name, type) \
    { name, sizeof(type) }
static const LayoutStruct structs[] = {
    SIZE("sim", SingeSimDef),
    SIZE("wind", SingeWindDef),
    SIZE("solver", SingeSolverDef),
    SIZE("gas", SingeGasDef),
    SIZE("contact", SingeContactDef),
    SIZE("sheet", SingeSheetDef),
    SIZE("material", SingeMaterialDef),
    SIZE("source", SingeSourceDef),
    SIZE("collider", SingeColliderDef),
    SIZE("pin", SingePinDef),
    SIZE("grid", SingeGridDef),
    SIZE("meshview", SingeMeshView),
    SIZE("param", SingeParam),
    SIZE("field", SingeField),
    SIZE("texture", SingeTexture),
    SIZE("error", SingeError),
    SIZE("view", SingeView),
    SIZE("surface", SingeSurface),
    SIZE("air", SingeGas),
    SIZE("stats", SingeStats),
    SIZE("event", SingeEvent),
    SIZE("counts", SingeCounts),
    SIZE("pose", SingePoseKey),
};

/// The lists, each by its address and its length.
struct Layout {
    const LayoutField *fields;
    size_t field_count;
    const LayoutArray *arrays;
    size_t array_count;
    const LayoutWord *words;
    size_t word_count;
    const LayoutStruct *structs;
    size_t struct_count;
};

#define LIST(list) list, sizeof(list) / sizeof *(list)
__attribute__((export_name("layout"))) const struct Layout *singe_layout(void);

const struct Layout *singe_layout(void) {
    static const struct Layout layout = {LIST(fields), LIST(arrays), LIST(words), LIST(structs)};
    return &layout;
}
