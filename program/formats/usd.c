#include "formats/usd.h"

#include <stdio.h>
#include <string.h>

const UsdAttribute usd_attributes[USD_OWN] = {
    [USD_POINTS] = {"points", "point3f[]", false},
    [USD_VELOCITIES] = {"velocities", "vector3f[]", false},
    [USD_NORMALS] = {"normals", "normal3f[]", true},
    [USD_ST] = {"primvars:st", "texCoord2f[]", true},
    [USD_REST] = {"primvars:rest", "float3[]", true},
    [USD_COLOUR] = {"primvars:displayColor", "color3f[]", true},
    [USD_COLOUR_INDICES] = {"primvars:displayColor:indices", "int[]", false},
    [USD_EMBER] = {"primvars:ember", "color3f[]", true},
    [USD_EMBER_INDICES] = {"primvars:ember:indices", "int[]", false},
    [USD_COUNTS] = {"faceVertexCounts", "int[]", false},
    [USD_INDICES] = {"faceVertexIndices", "int[]", false},
    [USD_EXTENT] = {"extent", "float3[]", false},
};

void usd_name(const char *name, char prim[USD_NAME]) {
    size_t n = 0;
    if (*name >= '0' && *name <= '9') prim[n++] = '_';
    for (const char *c = name; *c && n < USD_NAME - 16; c++) {
        const bool good = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || (*c >= '0' && *c <= '9');
        prim[n++] = good ? *c : '_';
    }
    if (!n) prim[n++] = '_';
    prim[n] = 0;
}

void usd_sheet_name(const OutputScene *scene, uint32_t sheet, char prim[USD_NAME]) {
    usd_name(scene->sheets[sheet].name, prim);
    const size_t length = strlen(prim);
    for (uint32_t i = 0, tries = 0; i < scene->sheet_count; i++) {
        char other[USD_NAME];
        if (i == sheet) continue;
        usd_name(scene->sheets[i].name, other);
        if (strcmp(other, prim) != 0 || (i > sheet && !tries)) continue;
        snprintf(prim + length, USD_NAME - length, "_%u", (unsigned)(sheet + 1 + 1000 * tries++));
        i = UINT32_MAX; // check all names again
    }
}
