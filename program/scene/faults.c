// Reports what the library refuses in the scene's words. A refused sheet stops the construction, so then each sheet is
// tried by itself and the faults of all are reported at once. A good scene is built once.
#include "scene/faults.h"

#include "common/printable.h"
#include "scene/schema.h"

/// Reports a fault of a sheet's mesh at the name of its file, with the line or the number of the face.
static void mesh_fault(const Scene *scene, uint32_t index, const Mesh *mesh, const SingeError *error, const char *what,
                       SceneMessages *messages) {
    const SceneFile *file = &scene->sheets[index].mesh;
    if (!file->name) {
        message_add(messages, scene->text, scene->sheets[index].location, "the grid cannot be used: %s", what);
        return;
    }

    // the cell of the error, or the first cell at its vertex
    uint32_t cell = mesh->cell_count;
    char words[40], face[40] = "";
    snprintf(words, sizeof words, "cell %lld", (long long)error->element);

    if (error->element >= 0 && strstr(error->message, words)) {
        cell = (uint32_t)error->element;
    } else if (error->element >= 0) {
        size_t corners = 4 * (size_t)mesh->cell_count, i = 0;
        while (i < corners && mesh->cells[i] != error->element) i++;
        cell = (uint32_t)(i / 4);
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
        if (!assets->meshes[i].positions) continue;

        SingeSheetDef def;
        scene_sheet_def(scene, assets, i, &def);
        def.name = "mesh";

        SceneParam which;
        for (int p = 0; scope == FAULTS_OF_MESHES && scene_param(p, &which); p++) {
            SingeParam *param = scene_param_at(&def.material, &which);
            *param = singe_param(param->value);
        }

        // a simulation of this sheet alone
        SingeError error = {0};
        SingeSimDef sim_def = singe_default_sim();
        SingeSim *sim;
        SingeSheetId id;
        SingeResult result = singe_sim_create(&sim_def, &sim, &error);
        if (!result) {
            result = singe_sim_add_sheet(sim, &def, &id);
            if (!result) result = singe_sim_commit(sim);
            if (result) error = *singe_sim_error(sim);
            singe_sim_destroy(sim);
        }

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

void fault_report(const Scene *scene, const SceneAssets *assets, const SceneFault *fault, SceneMessages *messages) {
    const SingeError *error = &fault->error;
    bool of_sheets = fault->object == FAULT_SHEET || fault->object == FAULT_COMMIT;
    if (of_sheets && error->code != SINGE_ERROR_MEMORY && sheet_faults(scene, assets, FAULTS_OF_SHEETS, messages))
        return;

    SceneLocation location = {0};
    switch (fault->object) {
    case FAULT_SIM: break;
    case FAULT_SHEET: location = scene->sheets[fault->index].location; break;
    case FAULT_COMMIT: // of all sheets
        if (scene->sheet_count == 1) location = scene->sheets[0].location;
        break;
    case FAULT_SOURCE: location = scene->sources[fault->index].location; break;
    case FAULT_COLLIDER: location = scene->colliders[fault->index].location; break;
    case FAULT_PIN: location = scene->pins[fault->index].location; break;
    case FAULT_RENDER_MESH: location = scene->sheets[fault->index].render_mesh.mesh.location; break;
    }

    message_add(messages, scene->text, location, "%s: %s", error->stage[0] ? error->stage : "simulation",
                error->message[0] ? error->message : singe_result_name(error->code));
}
