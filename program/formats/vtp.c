// VTK's XML files of polygons, with raw appended arrays, and their collection file (ParaView, VTK, PyVista).
//
// Each array is its length in bytes (u64) and its values, little-endian; an XML element has its offset.
#include "formats/output.h"
#include "formats/sink.h"

typedef struct VtpArray {
    const char *name, *type;
    int width; ///< values per item
    const void *values;
    size_t count; ///< items
} VtpArray;

static size_t value_size(const VtpArray *array) { return strcmp(array->type, "Int64") == 0 ? 8 : 4; }

/// Writes the element of an array that begins at *offset, and advances *offset.
static void put_element(Sink *xml, const VtpArray *array, uint64_t *offset) {
    sink_text(xml,
              "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"appended\" offset=\"%llu\"/>\n",
              array->type, array->name, array->width, (unsigned long long)*offset);
    *offset += 8 + value_size(array) * (size_t)array->width * array->count;
}

enum { POINT_VECTORS = 4, ARRAYS = POINT_VECTORS + SURFACE_FIELDS + 3 };

SingeResult vtp_write_frame(const char *path, const OutputScene *scene, const OutputFrame *frame, SingeError *error) {
    (void)scene;
    const SingeSurface *s = frame->surface;
    Sink sink = {.allocator = s->allocator};
    VtpArray arrays[ARRAYS];
    uint64_t offset = 0;

    const size_t n = s->vertex_count;
    const int fields = surface_field_count(s->wet), points = POINT_VECTORS + fields, all = points + 3;
    arrays[0] = (VtpArray){"normal", "Float32", 3, s->normal, n};
    arrays[1] = (VtpArray){"uv", "Float32", 2, s->uv, n};
    arrays[2] = (VtpArray){"velocity", "Float32", 3, s->velocity, n};
    arrays[3] = (VtpArray){"rest", "Float32", 3, s->rest_position, n};

    for (int i = 0; i < fields; i++)
        arrays[POINT_VECTORS + i] = (VtpArray){surface_fields[i].name, surface_fields[i].integer ? "Int32" : "Float32",
                                               1, surface_field(s, &surface_fields[i]), n};
    arrays[points] = (VtpArray){"points", "Float32", 3, s->position, n};
    arrays[points + 1] = (VtpArray){"connectivity", "Int32", 1, s->triangles, 3 * (size_t)s->triangle_count};
    arrays[points + 2] = (VtpArray){"offsets", "Int64", 1, NULL, s->triangle_count};

    sink_text(&sink, "<?xml version=\"1.0\"?>\n"
                     "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
                     "<PolyData>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
                     "format=\"ascii\">");
    sink_number(&sink, frame->time);
    sink_text(&sink,
              "</DataArray>\n</FieldData>\n<Piece NumberOfPoints=\"%u\" NumberOfVerts=\"0\" NumberOfLines=\"0\" "
              "NumberOfStrips=\"0\" NumberOfPolys=\"%u\">\n"
              "<PointData Scalars=\"temperature\" Vectors=\"velocity\" Normals=\"normal\" TCoords=\"uv\">\n",
              s->vertex_count, s->triangle_count);

    for (int i = 0; i < points; i++) put_element(&sink, &arrays[i], &offset);
    sink_text(&sink, "</PointData>\n<Points>\n");
    put_element(&sink, &arrays[points], &offset);
    sink_text(&sink, "</Points>\n<Polys>\n");

    for (int i = points + 1; i < all; i++) put_element(&sink, &arrays[i], &offset);
    sink_text(&sink, "</Polys>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_");

    for (int i = 0; i < all; i++) {
        const size_t count = (size_t)arrays[i].width * arrays[i].count;
        sink_u64(&sink, value_size(&arrays[i]) * count);
        if (arrays[i].values) sink_words(&sink, arrays[i].values, count);
        for (uint64_t k = 1; !arrays[i].values && k <= count; k++) sink_u64(&sink, 3 * k); // where triangles end
    }

    sink_text(&sink, "\n</AppendedData>\n</VTKFile>\n");
    return sink_write(&sink, path, error);
}

SingeResult pvd_write_root(const char *path, const OutputScene *scene, SingeError *error) {
    Sink sink = {0};
    sink_text(&sink, "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
                     "byte_order=\"LittleEndian\">\n<Collection>\n");

    for (int frame = 1; frame <= scene->frames; frame++) {
        sink_text(&sink, "<DataSet timestep=\"");
        sink_number(&sink, (frame - 1) / (double)scene->fps);
        sink_text(&sink, "\" part=\"0\" file=\"vtp/");

        // a name in an XML attribute
        for (const char *c = scene->name; *c; c++) {
            const char *entity = *c == '&'   ? "&amp;"
                                 : *c == '<' ? "&lt;"
                                 : *c == '>' ? "&gt;"
                                 : *c == '"' ? "&quot;"
                                             : NULL;
            if (entity) sink_text(&sink, "%s", entity);
            else sink_bytes(&sink, c, 1);
        }

        sink_text(&sink, ".%04d.vtp\"/>\n", frame);
    }

    sink_text(&sink, "</Collection>\n</VTKFile>\n");
    return sink_write(&sink, path, error);
}
