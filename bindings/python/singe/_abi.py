"""Made by bindings/python/generate.py from include/singe: do not edit."""

from ctypes import (CFUNCTYPE, POINTER, Structure, c_bool, c_char, c_char_p, c_double, c_float, c_int, c_int32,
                    c_int64, c_size_t, c_uint8, c_uint32, c_uint64, c_void_p)

VERSION = "0.2.0"

# by the name of the enumeration, "" for unnamed ones
ENUMS = {
    "SingeResult": {"SINGE_OK": 0, "SINGE_ERROR_ARGUMENT": 1, "SINGE_ERROR_MEMORY": 2, "SINGE_ERROR_MESH": 3,
                    "SINGE_ERROR_HANDLE": 4, "SINGE_ERROR_STATE": 5, "SINGE_ERROR_DIVERGED": 6,
                    "SINGE_ERROR_FORMAT": 7, "SINGE_ERROR_VERSION": 8, "SINGE_ERROR_FILE": 9, "SINGE_ERROR_LIMIT": 10,
                    "SINGE_ERROR_CANCELLED": 11},
    "SingeLogLevel": {"SINGE_LOG_INFO": 0, "SINGE_LOG_WARNING": 1, "SINGE_LOG_ERROR": 2},
    "SingeFieldKind": {"SINGE_FIELD_NONE": 0, "SINGE_FIELD_TEXTURE": 1, "SINGE_FIELD_ATTRIBUTE": 2,
                       "SINGE_FIELD_NOISE": 3},
    "SingeHeatOperator": {"SINGE_HEAT_SURFACE": 0, "SINGE_HEAT_UMBRELLA": 1, "SINGE_HEAT_UMBRELLA_LIVE": 2},
    "SingeColour": {"SINGE_RED": 0, "SINGE_GREEN": 1, "SINGE_BLUE": 2, "SINGE_YELLOW": 3, "SINGE_COLOUR_COUNT": 4},
    "SingeSourceKind": {"SINGE_SOURCE_BALL": 0, "SINGE_SOURCE_TEXTURE": 1, "SINGE_SOURCE_SPOT": 2,
                        "SINGE_SOURCE_CALLBACK": 3, "SINGE_SOURCE_ARRIVAL": 4, "SINGE_SOURCE_WATER": 5,
                        "SINGE_SOURCE_JET": 6, "SINGE_SOURCE_VORTEX": 7, "SINGE_SOURCE_ATTRACT": 8,
                        "SINGE_SOURCE_TURBULENCE": 9},
    "SingeColliderKind": {"SINGE_COLLIDER_PLANE": 0, "SINGE_COLLIDER_SPHERE": 1, "SINGE_COLLIDER_BOX": 2,
                          "SINGE_COLLIDER_CAPSULE": 3, "SINGE_COLLIDER_HEIGHTFIELD": 4, "SINGE_COLLIDER_MESH": 5,
                          "SINGE_COLLIDER_DEFORMING": 6},
    "SingeContactSides": {"SINGE_SIDES_TOUCHING": 0, "SINGE_SIDES_BOTH": 1},
    "SingeSolverMethod": {"SINGE_SOLVER_STRAND": 0, "SINGE_SOLVER_PAPER": 1, "SINGE_SOLVER_PAPER_LITERAL": 2,
                          "SINGE_SOLVER_ALL_AT_ONCE": 3, "SINGE_SOLVER_MASS_SPRING": 4},
    "SingeInstructions": {"SINGE_INSTRUCTIONS_BEST": 0, "SINGE_INSTRUCTIONS_PLAIN": 1, "SINGE_INSTRUCTIONS_X86_V2": 2,
                          "SINGE_INSTRUCTIONS_X86_V3": 3, "SINGE_INSTRUCTIONS_X86_V4": 4,
                          "SINGE_INSTRUCTIONS_ARM_NEON": 5, "SINGE_INSTRUCTIONS_WASM_SIMD128": 6},
    "SingeMeshQuads": {"SINGE_MESH_PAIR": 0, "SINGE_MESH_SPLIT": 1},
    "": {"SINGE_ALIVE": 1, "SINGE_PINNED": 2},
    "SingeEventKind": {"SINGE_EVENT_IGNITED": 0, "SINGE_EVENT_HOLE_OPENED": 1, "SINGE_EVENT_PIECE_FREED": 2},
    "SingeStage": {"SINGE_STAGE_HEAT": 0, "SINGE_STAGE_BURN": 1, "SINGE_STAGE_ABLATE": 2, "SINGE_STAGE_DYNAMICS": 3,
                   "SINGE_STAGE_GAS": 4, "SINGE_STAGE_COUNT": 5},
}

SingeTaskFn = CFUNCTYPE(None, c_void_p, c_int, c_int)
SingeFluxFn = CFUNCTYPE(None, c_void_p, c_void_p, POINTER(c_float), POINTER(c_float), POINTER(c_float))


class SingeError(Structure):
    _fields_ = [("code", c_int), ("stage", c_char * 24), ("element", c_int64), ("message", c_char * 400)]


class SingeAllocator(Structure):
    _fields_ = [("resize", CFUNCTYPE(c_void_p, c_void_p, c_void_p, c_size_t, c_size_t)), ("context", c_void_p)]


class SingeLog(Structure):
    _fields_ = [("write", CFUNCTYPE(None, c_void_p, c_int, c_char_p)), ("context", c_void_p)]


class SingeRecord(Structure):
    _fields_ = [("write", CFUNCTYPE(c_bool, c_void_p, c_void_p, c_size_t)), ("context", c_void_p)]


class SingeCancel(Structure):
    _fields_ = [("asked", CFUNCTYPE(c_bool, c_void_p)), ("context", c_void_p)]


class SingeTasks(Structure):
    _fields_ = [("enqueue", CFUNCTYPE(c_void_p, c_void_p, SingeTaskFn, c_void_p, c_int, c_int)),
                ("finish", CFUNCTYPE(None, c_void_p, c_void_p)), ("context", c_void_p)]


class SingeSheetId(Structure):
    _fields_ = [("index", c_uint32), ("generation", c_uint32)]


class SingeSourceId(Structure):
    _fields_ = [("index", c_uint32), ("generation", c_uint32)]


class SingeColliderId(Structure):
    _fields_ = [("index", c_uint32), ("generation", c_uint32)]


class SingePinId(Structure):
    _fields_ = [("index", c_uint32), ("generation", c_uint32)]


class SingeTexture(Structure):
    _fields_ = [("width", c_int), ("height", c_int), ("values", POINTER(c_float))]


class SingeNoise(Structure):
    _fields_ = [("scale", c_float), ("octaves", c_int), ("seed", c_uint32)]


class SingeAttribute(Structure):
    _fields_ = [("name", c_char_p), ("values", POINTER(c_float))]


class SingeField(Structure):
    _fields_ = [("kind", c_int), ("texture", SingeTexture), ("attribute", c_char_p), ("noise", SingeNoise)]


class SingeParam(Structure):
    _fields_ = [("value", c_float), ("to", c_float), ("field", POINTER(SingeField))]


class SingeMaterialDef(Structure):
    _fields_ = [("struct_size", c_size_t), ("grammage", SingeParam), ("reference_grammage", c_float),
                ("specific_heat", SingeParam), ("thickness", SingeParam), ("heat_operator", c_int),
                ("diffusivity", SingeParam), ("layer_exchange", SingeParam), ("convection", SingeParam),
                ("emissivity", SingeParam), ("loss_mass_floor", SingeParam), ("thickening", c_float),
                ("temperature", SingeParam), ("ignition_temperature", SingeParam), ("heat_of_combustion", SingeParam),
                ("heat_share", SingeParam), ("mass_rate", SingeParam), ("rate_ceiling", SingeParam),
                ("ash_exponent", SingeParam), ("mass_min", SingeParam), ("mass_loss", SingeParam),
                ("ash_density", SingeParam), ("char_yield", SingeParam), ("char_density", SingeParam),
                ("char_heat", SingeParam), ("char_rate", SingeParam), ("char_air", SingeParam),
                ("shrink_front", SingeParam), ("shrink_back", SingeParam), ("fibre_angle", SingeParam),
                ("fibre_shrink", SingeParam), ("ablate", c_bool), ("weight", SingeParam * 4),
                ("compliance", SingeParam * 4), ("char_weight", SingeParam), ("drag", SingeParam),
                ("damping", SingeParam), ("crease_radius", SingeParam), ("crease_share", SingeParam),
                ("strength", SingeParam), ("char_strength", SingeParam), ("pre_exponential", SingeParam),
                ("activation_energy", SingeParam), ("curvature_max", SingeParam), ("moisture", SingeParam),
                ("bending", SingeParam), ("smother_distance", SingeParam), ("air_supply", SingeParam)]


class SingePoseKey(Structure):
    _fields_ = [("time", c_float), ("position", c_float * 3), ("rotation", c_float * 4)]


class SingeValueKey(Structure):
    _fields_ = [("time", c_float), ("value", c_float)]


class SingeSheetDef(Structure):
    _fields_ = [("struct_size", c_size_t), ("name", c_char_p), ("vertex_count", c_uint32),
                ("positions", POINTER(c_float)), ("cell_count", c_uint32), ("cells", POINTER(c_uint32)),
                ("uv", POINTER(c_float)), ("attribute_count", c_uint32), ("attributes", POINTER(SingeAttribute)),
                ("material", SingeMaterialDef), ("velocity", c_float * 3), ("drop_pieces_below", c_float),
                ("corner_uv", POINTER(c_float)), ("source_vertex", POINTER(c_int32)), ("source_count", c_uint32),
                ("corner_source_vertex", POINTER(c_int32)), ("user_data", c_void_p)]


class SingeSourceDef(Structure):
    _fields_ = [("struct_size", c_size_t), ("kind", c_int), ("start", c_float), ("end", c_float),
                ("temperature", c_float), ("conductance", c_float), ("radius", c_float), ("falloff", c_float),
                ("power", c_float), ("path_count", c_uint32), ("path", POINTER(SingePoseKey)),
                ("texture", SingeTexture), ("flux", c_float), ("strength_count", c_uint32),
                ("strength", POINTER(SingeValueKey)), ("callback", SingeFluxFn), ("callback_context", c_void_p),
                ("position", c_float * 3), ("user_data", c_void_p), ("arrival_from", c_float),
                ("arrival_to", c_float), ("lead", c_float), ("wetting", c_float), ("direction", c_float * 3),
                ("speed", c_float), ("blow_out", c_float)]


class SingeColliderDef(Structure):
    _fields_ = [("struct_size", c_size_t), ("kind", c_int), ("radius", c_float), ("half_size", c_float * 3),
                ("height", c_float), ("friction", c_float), ("offset", c_float), ("temperature", c_float),
                ("conductance", c_float), ("contact_distance", c_float), ("path_count", c_uint32),
                ("path", POINTER(SingePoseKey)), ("sides", c_int), ("vertex_count", c_uint32),
                ("vertices", POINTER(c_float)), ("triangle_count", c_uint32), ("triangles", POINTER(c_uint32)),
                ("columns", c_uint32), ("rows", c_uint32), ("size", c_float * 2), ("heights", POINTER(c_float)),
                ("position", c_float * 3), ("rotation", c_float * 4), ("user_data", c_void_p), ("smothers", c_bool)]


class SingePinDef(Structure):
    _fields_ = [("struct_size", c_size_t), ("sheet", SingeSheetId), ("point_count", c_uint32),
                ("points", POINTER(c_float)), ("radius", c_float), ("vertex_count", c_uint32),
                ("vertices", POINTER(c_uint32)), ("path_count", c_uint32), ("path", POINTER(SingePoseKey)),
                ("user_data", c_void_p), ("end", c_float)]


class SingeWindDef(Structure):
    _fields_ = [("struct_size", c_size_t), ("velocity", c_float * 3), ("gust", c_float), ("gust_time", c_float),
                ("gust_size", c_float), ("seed", c_uint32)]


class SingeSolverDef(Structure):
    _fields_ = [("struct_size", c_size_t), ("method", c_int), ("substeps", c_int), ("projections", c_int),
                ("order", c_int * 4), ("regularisation", c_float * 4), ("attachments", c_bool),
                ("early_exit", c_bool), ("tolerance", c_float), ("stiffness", c_float), ("smoothing", c_float),
                ("smoothing_length", c_float), ("height_min", c_float), ("height_gain", c_float), ("creases", c_bool),
                ("tearing", c_bool), ("isotropic", c_bool), ("start", c_float)]


class SingeGasDef(Structure):
    _fields_ = [("struct_size", c_size_t), ("enabled", c_bool), ("cell_size", c_float), ("height", c_float),
                ("conductance", c_float), ("radiated", c_float), ("soot", c_float)]


class SingeContactDef(Structure):
    _fields_ = [("struct_size", c_size_t), ("enabled", c_bool), ("thickness", c_float), ("friction", c_float)]


class SingeSimDef(Structure):
    _fields_ = [("struct_size", c_size_t), ("allocator", SingeAllocator), ("log", SingeLog), ("tasks", SingeTasks),
                ("thread_count", c_int), ("instructions", c_int), ("seed", c_uint64), ("time_step", c_float),
                ("velocity_steps", c_int), ("pace", c_float), ("gravity", c_float * 3),
                ("ambient_temperature", c_float), ("air_density", c_float), ("heat_tolerance", c_float),
                ("surface_detail", c_float), ("surface_raggedness", c_float), ("wind", SingeWindDef),
                ("solver", SingeSolverDef), ("gas", SingeGasDef), ("contact", SingeContactDef),
                ("record", SingeRecord), ("cancel", SingeCancel)]


class SingeMeshDef(Structure):
    _fields_ = [("struct_size", c_size_t), ("name", c_char_p), ("vertex_count", c_uint32),
                ("positions", POINTER(c_float)), ("face_count", c_uint32), ("face_sizes", POINTER(c_uint32)),
                ("corners", POINTER(c_uint32)), ("uv", POINTER(c_float)), ("corner_uv", POINTER(c_float)),
                ("attribute_count", c_uint32), ("attributes", POINTER(SingeAttribute)), ("quads", c_int),
                ("weld", c_float), ("smallest", c_float), ("allocator", SingeAllocator), ("log", SingeLog)]


class SingeGridDef(Structure):
    _fields_ = [("struct_size", c_size_t), ("size", c_float * 2), ("cells", c_uint32 * 2), ("jitter", c_float),
                ("displacement", c_float), ("seed", c_uint32), ("allocator", SingeAllocator)]


class SingeMeshView(Structure):
    _fields_ = [("struct_size", c_size_t), ("vertex_count", c_uint32), ("cell_count", c_uint32),
                ("attribute_count", c_uint32), ("source_count", c_uint32), ("positions", POINTER(c_float)),
                ("cells", POINTER(c_uint32)), ("uv", POINTER(c_float)), ("corner_uv", POINTER(c_float)),
                ("attributes", POINTER(SingeAttribute)), ("source_vertex", POINTER(c_int32)),
                ("corner_source_vertex", POINTER(c_int32)), ("became", POINTER(c_uint32))]


class SingeSurface(Structure):
    _fields_ = [("vertex_count", c_uint32), ("triangle_count", c_uint32), ("fine_triangle_count", c_uint32),
                ("position", POINTER(c_float * 3)), ("normal", POINTER(c_float * 3)), ("uv", POINTER(c_float * 2)),
                ("velocity", POINTER(c_float * 3)), ("rest_position", POINTER(c_float * 3)),
                ("temperature", POINTER(c_float)), ("temperature_peak", POINTER(c_float)), ("mass", POINTER(c_float)),
                ("burn_rate", POINTER(c_float)), ("char_fraction", POINTER(c_float)),
                ("ash_fraction", POINTER(c_float)), ("burn", POINTER(c_float)), ("time_ignited", POINTER(c_float)),
                ("piece", POINTER(c_int32)), ("source_vertex", POINTER(c_int32)), ("sheet", POINTER(c_int32)),
                ("triangles", POINTER(c_uint32 * 3)), ("vertex_capacity", c_uint32), ("triangle_capacity", c_uint32),
                ("allocator", SingeAllocator), ("water", POINTER(c_float)), ("wet", c_bool)]


class SingeRenderMeshDef(Structure):
    _fields_ = [("struct_size", c_size_t), ("vertex_count", c_uint32), ("triangle_count", c_uint32),
                ("positions", POINTER(c_float)), ("uv", POINTER(c_float)), ("triangles", POINTER(c_uint32)),
                ("reach", c_float), ("edge_max", c_float), ("rigid", c_float), ("beside", c_bool), ("by_uv", c_bool)]


class SingeGas(Structure):
    _fields_ = [("size", c_uint32 * 3), ("origin", c_float * 3), ("cell", c_float), ("temperature", POINTER(c_float)),
                ("smoke", POINTER(c_float)), ("flame", POINTER(c_float)), ("velocity", POINTER(c_float * 3))]


class SingeView(Structure):
    _fields_ = [("struct_size", c_size_t), ("time", c_double), ("step", c_uint64), ("topology_version", c_uint64),
                ("particle_count", c_uint32), ("vertex_count", c_uint32), ("cell_count", c_uint32),
                ("spring_count", c_uint32 * 4), ("position", POINTER(c_float * 4)),
                ("velocity", POINTER(c_float * 4)), ("rest_position", POINTER(c_float * 4)),
                ("uv", POINTER(c_float * 2)), ("area", POINTER(c_float)), ("mass", POINTER(c_float)),
                ("fuel", POINTER(c_float)), ("temperature", POINTER(c_float)), ("temperature_peak", POINTER(c_float)),
                ("burn_rate", POINTER(c_float)), ("time_ignited", POINTER(c_float)), ("time_burnt", POINTER(c_float)),
                ("piece", POINTER(c_int32)), ("particle_flags", POINTER(c_uint8)), ("cell_flags", POINTER(c_uint8)),
                ("cells", POINTER(c_uint32 * 4)), ("springs", (POINTER(c_uint32 * 2)) * 4),
                ("spring_length", POINTER(c_float) * 4), ("spring_rest", POINTER(c_float) * 4),
                ("spring_flags", POINTER(c_uint8) * 4), ("line_force", POINTER(c_float * 6)),
                ("source_vertex", POINTER(c_int32))]


class SingeSheetRange(Structure):
    _fields_ = [("struct_size", c_size_t), ("vertex_first", c_uint32), ("vertex_count", c_uint32),
                ("torn_count", c_uint32), ("reserve_count", c_uint32), ("cell_first", c_uint32),
                ("cell_count", c_uint32), ("centre_first", c_uint32)]


class SingeEvent(Structure):
    _fields_ = [("kind", c_int), ("element", c_int32), ("time", c_double), ("position", c_float * 3)]


class SingeTimers(Structure):
    _fields_ = [("seconds", c_double * 5), ("steps", c_uint64), ("heat_iterations", c_uint64),
                ("strands_projected", c_uint64), ("contacts", c_uint64), ("projection_seconds", c_double),
                ("springs_projected", c_uint64), ("projection_iterations", c_uint64), ("projection_flops", c_double),
                ("projection_bytes", c_double), ("contact_seconds", c_double), ("contact_searches", c_uint64),
                ("contact_repulsions", c_uint64), ("contact_stops", c_uint64), ("contact_unresolved", c_uint64),
                ("contact_dropped", c_uint64), ("contact_pairs", c_uint64), ("contact_halts", c_uint64),
                ("contact_rounds", c_uint64), ("contact_looks", c_uint64), ("contact_find_seconds", c_double),
                ("contact_push_seconds", c_double), ("contact_stop_seconds", c_double)]


class SingeStats(Structure):
    _fields_ = [("time", c_double), ("particles", c_uint32), ("springs", c_uint32), ("cells", c_uint32),
                ("pieces", c_uint32), ("mass", c_double), ("mass_initial", c_double), ("mass_burnt", c_double),
                ("mass_removed", c_double), ("burnt_fraction", c_double), ("temperature_max", c_float),
                ("heat_in", c_double), ("heat_lost", c_double), ("heat_of_combustion", c_double),
                ("heat_stored", c_double), ("ledger_error", c_double), ("mass_ledger_error", c_double),
                ("strain_mean", c_double), ("strain_p99", c_double), ("strain_max", c_double),
                ("inverted_cells", c_uint32), ("intersecting_cells", c_uint32), ("speed_rms_unburnt", c_double),
                ("thickening", c_float), ("front_speed", c_double), ("tears", c_uint32), ("ledgers_close", c_bool),
                ("arrival_error", c_double), ("arrival_missed", c_uint32), ("pace", c_float), ("water", c_double),
                ("energy_kinetic", c_double), ("energy_elastic", c_double), ("energy_gravity", c_double),
                ("energy_lost", c_double)]


class SingeCounts(Structure):
    _fields_ = [("particles", c_uint32), ("cells", c_uint32), ("springs", c_uint32 * 4), ("strands", c_uint32 * 4),
                ("families", c_uint32 * 4), ("mean_strand_length", c_double), ("cell_size", c_float),
                ("memory", c_size_t), ("instructions", c_int)]


class SingeReplay(Structure):
    _fields_ = [("struct_size", c_size_t), ("version", c_char * 20), ("calls", c_uint64), ("steps", c_uint64),
                ("complete", c_bool), ("same", c_bool), ("step", c_uint64), ("what", c_char * 160)]


class SingeNetworkDef(Structure):
    _fields_ = [("struct_size", c_size_t), ("allocator", SingeAllocator), ("tasks", SingeTasks),
                ("thread_count", c_int), ("particle_count", c_uint32), ("positions", POINTER(c_double)),
                ("inverse_masses", POINTER(c_double)), ("held", POINTER(c_uint8)), ("spring_count", c_uint32),
                ("ends", POINTER(c_uint32)), ("lengths", POINTER(c_double)), ("weights", POINTER(c_double)),
                ("compliances", POINTER(c_double)), ("set_count", c_uint32), ("sets", POINTER(c_uint32)),
                ("literal", c_bool), ("regularisation", c_double), ("time_step", c_double), ("tolerance", c_double),
                ("iterations", c_int)]


class SingeNetworkReport(Structure):
    _fields_ = [("iterations", c_uint32), ("residual", c_double)]


STRUCTS = [SingeError, SingeAllocator, SingeLog, SingeRecord, SingeCancel, SingeTasks, SingeSheetId, SingeSourceId,
           SingeColliderId, SingePinId, SingeTexture, SingeNoise, SingeAttribute, SingeField, SingeParam,
           SingeMaterialDef, SingePoseKey, SingeValueKey, SingeSheetDef, SingeSourceDef, SingeColliderDef,
           SingePinDef, SingeWindDef, SingeSolverDef, SingeGasDef, SingeContactDef, SingeSimDef, SingeMeshDef,
           SingeGridDef, SingeMeshView, SingeSurface, SingeRenderMeshDef, SingeGas, SingeView, SingeSheetRange,
           SingeEvent, SingeTimers, SingeStats, SingeCounts, SingeReplay, SingeNetworkDef, SingeNetworkReport]
# enumerations of fields
FIELD_ENUMS = {"SingeError.code": "SingeResult", "SingeField.kind": "SingeFieldKind",
               "SingeMaterialDef.heat_operator": "SingeHeatOperator", "SingeSourceDef.kind": "SingeSourceKind",
               "SingeColliderDef.kind": "SingeColliderKind", "SingeColliderDef.sides": "SingeContactSides",
               "SingeSolverDef.method": "SingeSolverMethod", "SingeSolverDef.order": "SingeColour",
               "SingeSimDef.instructions": "SingeInstructions", "SingeMeshDef.quads": "SingeMeshQuads",
               "SingeEvent.kind": "SingeEventKind", "SingeCounts.instructions": "SingeInstructions"}
# name: (result, arguments)
FUNCTIONS = {
    "singe_result_name": (c_char_p, [c_int]),
    "singe_version": (c_char_p, []),
    "singe_param": (SingeParam, [c_float]),
    "singe_init_material": (None, [POINTER(SingeMaterialDef), c_size_t]),
    "singe_material_preset": (c_int, [c_char_p, POINTER(SingeMaterialDef), POINTER(SingeError)]),
    "singe_material_preset_name": (c_char_p, [c_uint32]),
    "singe_init_sheet": (None, [POINTER(SingeSheetDef), c_size_t]),
    "singe_init_source": (None, [POINTER(SingeSourceDef), c_size_t]),
    "singe_init_collider": (None, [POINTER(SingeColliderDef), c_size_t]),
    "singe_init_pin": (None, [POINTER(SingePinDef), c_size_t]),
    "singe_init_wind": (None, [POINTER(SingeWindDef), c_size_t]),
    "singe_init_solver": (None, [POINTER(SingeSolverDef), c_size_t]),
    "singe_init_solver_method": (None, [POINTER(SingeSolverDef), c_size_t, c_int]),
    "singe_init_gas": (None, [POINTER(SingeGasDef), c_size_t]),
    "singe_init_contact": (None, [POINTER(SingeContactDef), c_size_t]),
    "singe_init_sim": (None, [POINTER(SingeSimDef), c_size_t]),
    "singe_init_mesh": (None, [POINTER(SingeMeshDef), c_size_t]),
    "singe_init_grid": (None, [POINTER(SingeGridDef), c_size_t]),
    "singe_mesh_create": (c_int, [POINTER(SingeMeshDef), POINTER(c_void_p), POINTER(SingeError)]),
    "singe_mesh_create_grid": (c_int, [POINTER(SingeGridDef), POINTER(c_void_p), POINTER(SingeError)]),
    "singe_mesh_destroy": (None, [c_void_p]),
    "singe_mesh_read": (None, [c_void_p, POINTER(SingeMeshView), c_size_t]),
    "singe_surface_release": (None, [POINTER(SingeSurface), c_size_t]),
    "singe_init_render_mesh": (None, [POINTER(SingeRenderMeshDef), c_size_t]),
    "singe_sim_create": (c_int, [POINTER(SingeSimDef), POINTER(c_void_p), POINTER(SingeError)]),
    "singe_sim_destroy": (None, [c_void_p]),
    "singe_sim_error": (POINTER(SingeError), [c_void_p]),
    "singe_sim_add_sheet": (c_int, [c_void_p, POINTER(SingeSheetDef), POINTER(SingeSheetId)]),
    "singe_sim_commit": (c_int, [c_void_p]),
    "singe_sim_add_source": (c_int, [c_void_p, POINTER(SingeSourceDef), POINTER(SingeSourceId)]),
    "singe_sim_remove_source": (c_int, [c_void_p, SingeSourceId]),
    "singe_sim_set_source_callback": (c_int, [c_void_p, SingeSourceId, SingeFluxFn, c_void_p]),
    "singe_sim_add_collider": (c_int, [c_void_p, POINTER(SingeColliderDef), POINTER(SingeColliderId)]),
    "singe_sim_remove_collider": (c_int, [c_void_p, SingeColliderId]),
    "singe_sim_add_pin": (c_int, [c_void_p, POINTER(SingePinDef), POINTER(SingePinId)]),
    "singe_sim_remove_pin": (c_int, [c_void_p, SingePinId]),
    "singe_sim_move_source": (c_int, [c_void_p, SingeSourceId, c_uint32, POINTER(SingePoseKey)]),
    "singe_sim_move_collider": (c_int, [c_void_p, SingeColliderId, c_uint32, POINTER(SingePoseKey)]),
    "singe_sim_move_pin": (c_int, [c_void_p, SingePinId, c_uint32, POINTER(SingePoseKey)]),
    "singe_sim_set_collider_vertices": (c_int, [c_void_p, SingeColliderId, POINTER(c_float), c_double]),
    "singe_sim_set_pin_positions": (c_int, [c_void_p, SingePinId, POINTER(c_float), c_double]),
    "singe_sim_pin_particles": (POINTER(c_uint32), [c_void_p, SingePinId, POINTER(c_uint32)]),
    "singe_sim_sheets": (c_uint32, [c_void_p, POINTER(SingeSheetId), c_uint32]),
    "singe_sim_sources": (c_uint32, [c_void_p, POINTER(SingeSourceId), c_uint32]),
    "singe_sim_colliders": (c_uint32, [c_void_p, POINTER(SingeColliderId), c_uint32]),
    "singe_sim_pins": (c_uint32, [c_void_p, POINTER(SingePinId), c_uint32]),
    "singe_sim_sheet_user_data": (c_void_p, [c_void_p, SingeSheetId]),
    "singe_sim_source_user_data": (c_void_p, [c_void_p, SingeSourceId]),
    "singe_sim_collider_user_data": (c_void_p, [c_void_p, SingeColliderId]),
    "singe_sim_pin_user_data": (c_void_p, [c_void_p, SingePinId]),
    "singe_sim_set_sheet_user_data": (c_int, [c_void_p, SingeSheetId, c_void_p]),
    "singe_sim_set_source_user_data": (c_int, [c_void_p, SingeSourceId, c_void_p]),
    "singe_sim_set_collider_user_data": (c_int, [c_void_p, SingeColliderId, c_void_p]),
    "singe_sim_set_pin_user_data": (c_int, [c_void_p, SingePinId, c_void_p]),
    "singe_sim_set_wind": (c_int, [c_void_p, POINTER(SingeWindDef)]),
    "singe_sim_set_gravity": (c_int, [c_void_p, POINTER(c_float)]),
    "singe_sim_set_pace": (c_int, [c_void_p, c_float]),
    "singe_sim_set_ambient_temperature": (c_int, [c_void_p, c_float]),
    "singe_sim_set_velocity": (c_int, [c_void_p, SingeSheetId, c_uint32, c_uint32, POINTER(c_float)]),
    "singe_sim_set_material": (c_int, [c_void_p, SingeSheetId, POINTER(SingeMaterialDef), POINTER(c_float)]),
    "singe_sim_step": (c_int, [c_void_p]),
    "singe_sim_advance": (c_int, [c_void_p, c_double, c_uint32, POINTER(c_uint32)]),
    "singe_sim_remainder": (c_double, [c_void_p]),
    "singe_sim_read_sheet_range": (None, [c_void_p, SingeSheetId, POINTER(SingeSheetRange), c_size_t]),
    "singe_sim_read_view": (None, [c_void_p, POINTER(SingeView), c_size_t]),
    "singe_sim_events": (POINTER(SingeEvent), [c_void_p, POINTER(c_size_t)]),
    "singe_sim_read_timers": (None, [c_void_p, POINTER(SingeTimers), c_size_t]),
    "singe_sim_read_stats": (None, [c_void_p, POINTER(SingeStats), c_size_t]),
    "singe_sim_read_counts": (None, [c_void_p, POINTER(SingeCounts), c_size_t]),
    "singe_sim_draw": (c_int, [c_void_p, POINTER(SingeSurface), c_size_t]),
    "singe_sim_add_render_mesh": (c_int, [c_void_p, SingeSheetId, POINTER(SingeRenderMeshDef)]),
    "singe_sim_read_gas": (None, [c_void_p, POINTER(SingeGas), c_size_t]),
    "singe_sim_save": (c_int, [c_void_p, POINTER(POINTER(c_uint8)), POINTER(c_size_t)]),
    "singe_sim_free_bytes": (None, [c_void_p, POINTER(c_uint8), c_size_t]),
    "singe_sim_load": (c_int, [POINTER(SingeSimDef), POINTER(c_uint8), c_size_t, POINTER(c_void_p),
                               POINTER(SingeError)]),
    "singe_sim_clone": (c_int, [c_void_p, POINTER(c_void_p)]),
    "singe_replay_read": (c_int, [POINTER(SingeSimDef), POINTER(c_uint8), c_size_t, POINTER(SingeReplay), c_size_t,
                                  POINTER(SingeError)]),
    "singe_init_network": (None, [POINTER(SingeNetworkDef), c_size_t]),
    "singe_network_create": (c_int, [POINTER(SingeNetworkDef), POINTER(c_void_p), POINTER(SingeError)]),
    "singe_network_destroy": (None, [c_void_p]),
    "singe_network_positions": (POINTER(c_double), [c_void_p]),
    "singe_network_set_size": (c_uint32, [c_void_p, c_uint32]),
    "singe_network_project": (c_int, [c_void_p, c_uint32, POINTER(SingeNetworkReport)]),
    "singe_network_errors": (c_double, [c_void_p, c_uint32, POINTER(c_double)]),
    "singe_network_jacobian": (None, [c_void_p, c_uint32, POINTER(c_double)]),
    "singe_network_matrix": (None, [c_void_p, c_uint32, POINTER(c_double)]),
}
