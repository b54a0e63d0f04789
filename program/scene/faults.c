// Finds every sheet that the library refuses, by trying each by itself, so that all are reported at once. Done only if
// the scene has been refused: a good scene is built once.
#include "scene/faults.h"

#include "common/printable.h"
#include "scene/schema.h"

#include <string.h>

static SingeResult sheet_try(const SingeSheetDef *def, SingeError *error) {
    SingeSimDef sim_def = singe_default_sim();
    SingeSim *sim;
    SingeSheetId id;
    SingeResult result = singe_sim_create(&sim_def, &sim, error);
    if (result) return result;
    result = singe_sim_add_sheet(sim, def, &id);
    if (!result) result = singe_sim_commit(sim);
    if (result) *error = *singe_sim_error(sim);
    singe_sim_destroy(sim);
    return result;
}

/// The cell of an error, or the first cell at its vertex; cell_count if there is none.
static uint32_t fault_cell(const Mesh *mesh, const SingeError *error) {
    char cell[40];
    snprintf(cell, sizeof cell, "cell %lld", (long long)error->element);
    if (error->element < 0) return mesh->cell_count;
    if (strstr(error->message, cell)) return (uint32_t)error->element;
    size_t corners = 4 * (size_t)mesh->cell_count, i = 0;
    while (i < corners && mesh->cells[i] != error->element) i++;
    return (uint32_t)(i / 4);
}

static void mesh_fault(const Scene *scene, uint32_t index, const Mesh *mesh, const SingeError *error, const char *what,
                       SceneMessages *messages) {
    const SceneFile *file = &scene->sheets[index].mesh;
    uint32_t cell = fault_cell(mesh, error);
    char face[40] = "";
    if (!file->name) {
        message_add(messages, scene->text, scene->sheets[index].location, "the grid cannot be used: %s", what);
        return;
    }
    if (cell < mesh->cell_count && mesh->cell_lines)
        snprintf(face, sizeof face, ":%u", (unsigned)mesh->cell_lines[cell]);
    else if (cell < mesh->cell_count)
        snprintf(face, sizeof face, ": face %u", (unsigned)(mesh->cell_faces ? mesh->cell_faces[cell] : cell) + 1);
    message_add(messages, scene->text, file->location, "%s%s: %s (cells and vertices counted from 0)",
                shown_path(file->name).text, face, what);
}

bool sheet_faults(const Scene *scene, const SceneAssets *assets, FaultScope scope, SceneMessages *messages) {
    static const char prefix[] = "sheet 'mesh': "; // the library begins its messages with the name of the sheet
    bool any = false;
    for (uint32_t i = 0; i < scene->sheet_count; i++) {
        SingeSheetDef def;
        SingeError error = {0};
        if (!assets->meshes[i].positions) continue;
        scene_sheet_def(scene, assets, i, &def);
        def.name = "mesh";
        SceneParam which;
        for (int p = 0; scope == FAULTS_OF_MESHES && scene_param(p, &which); p++) {
            SingeParam *param = scene_param_at(&def.material, &which);
            *param = singe_param(param->value);
        }
        SingeResult result = sheet_try(&def, &error);
        bool mesh = result == SINGE_ERROR_MESH;
        if (!result || result == SINGE_ERROR_MEMORY || (scope == FAULTS_OF_MESHES && !mesh)) continue;
        const char *what = error.message;
        if (strncmp(what, prefix, sizeof prefix - 1) == 0) what += sizeof prefix - 1;
        if (mesh) mesh_fault(scene, i, &assets->meshes[i], &error, what, messages);
        else
            message_add(messages, scene->text, scene->sheets[i].location, "%s",
                        what[0] ? what : singe_result_name(result));
        any = true;
    }
    return any;
}
