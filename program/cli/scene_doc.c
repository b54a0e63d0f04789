// singe scene-doc and scene-schema: the reference and the JSON Schema of scene files, from the schema that reads them.
#include <stdio.h>

#include "cli/args.h"
#include "cli/cli.h"
#include "scene/scene.h"

const ArgCommand scene_doc_command = {.name = "scene-doc",
                                      .summary = "Prints the reference of scene files (docs/scene.md).",
                                      .examples = "singe scene-doc > scene.md"};

const ArgCommand scene_schema_command = {
    .name = "scene-schema",
    .summary = "Prints the JSON Schema of scene files, for completion and checks in editors.",
    .footer = "An editor with the YAML language server takes it by a comment in the scene's first line:\n"
              "  # yaml-language-server: $schema=singe.schema.json",
    .examples = "singe scene-schema > singe.schema.json\n"
                "check-jsonschema --schemafile singe.schema.json letter.yaml"};

static ExitCode print_all(const ArgCommand *command, void (*print)(FILE *file), int argc, char **argv) {
    ExitCode code;
    if (!args_read(command, argc, argv, NULL, &code)) return code;

    setvbuf(stdout, NULL, _IOFBF, 1 << 18); // written in one piece, so that main gets the reason of a failure
    print(stdout);
    return EXIT_GOOD; // main checks whether it was written
}

int command_scene_doc(int argc, char **argv) { return print_all(&scene_doc_command, scene_document, argc, argv); }

int command_scene_schema(int argc, char **argv) {
    return print_all(&scene_schema_command, scene_json_schema, argc, argv);
}
