// Shared by the frames and the root of the USD format: names and the layout of a stage.
//
//     /NAME                 Xform
//     /NAME/sheets/SHEET    Mesh of a sheet; with a picture its faces are in the subsets `fresh` and `burnt`
//     /NAME/gas, /NAME/camera, /NAME/light, /NAME/materials, /NAME/props: only in the root
#pragma once

#include "formats/output.h"
#include "formats/sink.h"

enum { USD_NAME = 160 };

/// A valid prim name: letters, digits and underscores; other characters become underscores.
void usd_name(const char *name, char prim[USD_NAME]);
/// The prim name of a sheet, different from those of earlier sheets.
void usd_sheet_name(const OutputScene *scene, uint32_t sheet, char prim[USD_NAME]);

/// The file of usd_write_frame in memory; free the bytes, also after failure. `path` is for messages.
SINGE_NODISCARD SingeResult usd_frame_bytes(const char *path, const OutputScene *scene, const OutputFrame *frame,
                                            Sink *bytes, SingeError *error);
/// The root's text.
void usd_put_root(Sink *sink, const OutputScene *scene);

/// An attribute of a sheet's mesh.
typedef struct UsdAttribute {
    const char *name, *type;
    bool vertex; ///< interpolation "vertex"
} UsdAttribute;

enum {
    USD_POINTS,
    USD_VELOCITIES,
    USD_NORMALS,
    USD_ST,
    USD_REST,
    USD_COLOUR,
    USD_COLOUR_INDICES,
    USD_EMBER,
    USD_EMBER_INDICES,
    USD_COUNTS,
    USD_INDICES,
    USD_EXTENT,
    USD_OWN
};
/// The first USD_OWN attributes; the fields of fields.h follow as primvars.
extern const UsdAttribute usd_attributes[USD_OWN];
