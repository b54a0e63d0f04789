// Singe in JavaScript: the public functions of libsinge (include/singe) as classes. One module holds many simulations.
import { Memory, type Exports, type Numbers } from "./memory.js";
import type {
    ColliderOptions, ContactOptions, GasOptions, Key, MaterialOptions, PinOptions, SheetOptions, SimOptions, SolverOptions, SourceOptions, Texture,
    Vector, WindOptions,
} from "./options.js";

export * from "./options.js";

export interface SimulationOptions extends SimOptions {
    wind?: WindOptions;
    solver?: SolverOptions;
    gas?: GasOptions;
    contact?: ContactOptions;
}

/** A material: that of a preset (docs/materials.md), with changes. */
export type Material = MaterialOptions & { base?: string };

/** A flat rectangle of cells about the origin of the x-y plane, front upwards. */
export interface Grid {
    /** m along x and y */
    size: readonly [number, number];
    cells: readonly [number, number];
    /** of a cell, 0 to 0.3: how far vertices are off the grid, so that folds do not follow its lines; 0.15 */
    jitter?: number;
    /** m: height of waves in the rest shape; 0 */
    displacement?: number;
    seed?: number;
}

/** The cells of a sheet as they are; `Files.quads` makes them of faces. */
export interface Quads {
    /** x, y, z of each vertex, m */
    positions: ArrayLike<number>;
    /** four vertices of each cell */
    cells: ArrayLike<number>;
    /** u, v of each vertex */
    uv?: ArrayLike<number>;
    /** u, v of each corner of the cells, where there are seams */
    corner_uv?: ArrayLike<number>;
}

/** Faces of any number of corners. */
export interface Faces {
    /** x, y, z of each vertex, m */
    positions: ArrayLike<number>;
    /** vertices, face after face */
    corners: ArrayLike<number>;
    /** corners of each face; without it all have 3 */
    sizes?: ArrayLike<number>;
    /** u, v of each vertex */
    uv?: ArrayLike<number>;
    /** u, v of each corner, where the mesh has seams */
    corner_uv?: ArrayLike<number>;
}

export interface Source extends SourceOptions {
    position?: Vector;
    path?: readonly Key[];
    /** of the kinds texture, arrival and water */
    texture?: Texture;
}
export interface Collider extends ColliderOptions {
    position?: Vector;
    rotation?: readonly [number, number, number, number];
    path?: readonly Key[];
    /** of a closed mesh: x, y, z of each vertex, and the vertices of each triangle */
    vertices?: ArrayLike<number>;
    triangles?: ArrayLike<number>;
}
export interface Pin extends PinOptions {
    sheet: Handle;
    /** x, y, z of points of the sheet at rest */
    points?: ArrayLike<number>;
    /** of the sheet's mesh */
    vertices?: ArrayLike<number>;
    path?: readonly Key[];
}

/** A sheet, a source, a collider or a pin of one simulation. */
export interface Handle { readonly index: number; readonly generation: number }

export interface SimulationEvent { kind: "ignited" | "hole" | "freed"; element: number; time: number; position: Vector }

/** What a call of the library refused, in its own words. */
export class SingeError extends Error {
    constructor(readonly stage: string, readonly element: number, message: string) {
        super(`${stage}: ${message}`);
        this.name = "SingeError";
    }
}

const EVENTS = ["ignited", "hole", "freed"] as const;

/** Compiles singe.wasm: its address, its bytes, or a response that brings them. Needs WebAssembly with simd128. */
export async function load(source: URL | string | BufferSource | Response | Promise<Response>): Promise<Singe> {
    const given = await source;
    const bytes = typeof given === "string" || given instanceof URL ? fetch(given) : given;
    let memory: WebAssembly.Memory;
    const imports = { wasi_snapshot_preview1: {
        clock_time_get: (_: number, __: bigint, at: number): number => {
            new DataView(memory.buffer).setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
            return 0;
        },
        // the library writes no files and ends no process
        fd_close: () => 8, fd_seek: () => 8, fd_write: () => 8,
    } };
    const loaded = bytes instanceof ArrayBuffer || ArrayBuffer.isView(bytes)
        ? await WebAssembly.instantiate(bytes as BufferSource, imports)
        : await WebAssembly.instantiateStreaming(bytes as Response, imports);
    memory = loaded.instance.exports.memory as WebAssembly.Memory;
    const call = loaded.instance.exports as unknown as Exports;
    call._initialize();
    return new Singe(new Memory(memory, call));
}

export class Singe {
    constructor(readonly memory: Memory) {}

    get version(): string { return this.memory.text(this.memory.call.singe_version()); }

    /** An empty simulation, to be freed by its destroy(). */
    create(options: SimulationOptions = {}): Simulation { return Simulation.make(this.memory, options); }

    /** A simulation from the bytes of its save(): the next steps have the same bits. */
    restore(bytes: Uint8Array): Simulation { return Simulation.restore(this.memory, bytes); }
}

export class Simulation {
    private surface: number;

    private constructor(private readonly memory: Memory, private sim: number) {
        this.surface = memory.call.malloc(memory.size("surface"));
        new Uint8Array(memory.memory.buffer, this.surface, memory.size("surface")).fill(0);
    }

    // ---- making

    static make(memory: Memory, options: SimulationOptions): Simulation {
        return memory.during(() => {
            const def = simDef(memory, options), place = memory.take(4), error = memory.take(memory.size("error"));
            if (memory.call.singe_sim_create(def, place, error)) throw errorAt(memory, error);
            return new Simulation(memory, memory.u32(place));
        });
    }

    static restore(memory: Memory, bytes: Uint8Array): Simulation {
        return memory.during(() => {
            const def = simDef(memory, {}), place = memory.take(4), error = memory.take(memory.size("error"));
            const at = memory.take(bytes.length);
            new Uint8Array(memory.memory.buffer, at, bytes.length).set(bytes);
            if (memory.call.singe_sim_load(def, at, bytes.length, place, error)) throw errorAt(memory, error);
            return new Simulation(memory, memory.u32(place));
        });
    }

    destroy(): void {
        if (!this.sim) return;
        const { memory } = this;
        memory.call.singe_surface_release(this.surface, memory.size("surface"));
        memory.call.free(this.surface);
        memory.call.singe_sim_destroy(this.sim);
        this.sim = 0;
    }

    /** Adds a sheet before the commit. */
    addSheet(shape: Grid | Quads, material: Material = {}, options: SheetOptions & Placement = {}): Handle {
        const { memory } = this;
        return memory.during(() => {
            const { translate, rotate, ...rest } = options, { base, ...changes } = material;
            const def = memory.take(memory.size("sheet")), inside = memory.at(def, "sheet", "material");
            memory.set(inside, "material", "struct_size", memory.size("material"));
            memory.call.singe_init_sheet(def, memory.size("sheet"));
            if (base) {
                const error = memory.take(memory.size("error"));
                if (memory.call.singe_material_preset(memory.putText(base), inside, error)) throw errorAt(memory, error);
            }
            memory.write(inside, "material", changes);
            memory.write(def, "sheet", rest);

            const { positions, cells, uv, corner_uv } = "cells" in shape && "positions" in shape ? shape : gridQuads(memory, shape);
            const placed = Float32Array.from(positions);
            place(placed, rotate ?? [0, 0, 0], translate ?? [0, 0, 0]);
            memory.write(def, "sheet", {
                vertex_count: placed.length / 3, positions: memory.put(placed), cell_count: cells.length / 4, cells: memory.put(cells, "uint32"),
                uv: uv ? memory.put(uv) : 0, corner_uv: corner_uv ? memory.put(corner_uv) : 0,
            });
            return this.handle((id) => memory.call.singe_sim_add_sheet(this.sim, def, id));
        });
    }

    /** Builds what steps need. Sheets come before, all else at any time. */
    commit(): void { this.check(this.memory.call.singe_sim_commit(this.sim)); }

    addSource(source: Source): Handle {
        return this.memory.during(() => {
            const def = this.def("source"), { path, texture, ...options } = source, { memory } = this;
            memory.write(def, "source", options);
            if (path) memory.write(def, "source", { path: keys(memory, path), path_count: path.length });
            if (texture) memory.putTexture(memory.at(def, "source", "texture"), "source", texture);
            return this.handle((id) => memory.call.singe_sim_add_source(this.sim, def, id));
        });
    }

    addCollider(collider: Collider): Handle {
        return this.memory.during(() => {
            const def = this.def("collider"), { path, vertices, triangles, ...options } = collider, { memory } = this;
            memory.write(def, "collider", options);
            if (path) memory.write(def, "collider", { path: keys(memory, path), path_count: path.length });
            if (vertices) memory.write(def, "collider", { vertices: memory.put(vertices), vertex_count: vertices.length / 3 });
            if (triangles)
                memory.write(def, "collider", { triangles: memory.put(triangles, "uint32"), triangle_count: triangles.length / 3 });
            return this.handle((id) => memory.call.singe_sim_add_collider(this.sim, def, id));
        });
    }

    addPin(pin: Pin): Handle {
        return this.memory.during(() => {
            const def = this.def("pin"), { sheet, points, vertices, path, ...options } = pin, { memory } = this;
            memory.write(def, "pin", options);
            const id = memory.at(def, "pin", "sheet");
            memory.data.setUint32(id, sheet.index, true);
            memory.data.setUint32(id + 4, sheet.generation, true);
            if (points) memory.write(def, "pin", { points: memory.put(points), point_count: points.length / 3 });
            if (vertices) memory.write(def, "pin", { vertices: memory.put(vertices, "uint32"), vertex_count: vertices.length });
            if (path) memory.write(def, "pin", { path: keys(memory, path), path_count: path.length });
            return this.handle((place) => memory.call.singe_sim_add_pin(this.sim, def, place));
        });
    }

    // ---- changing

    removeSource(id: Handle): void { this.withHandle(id, (at) => this.memory.call.singe_sim_remove_source(this.sim, at)); }
    removeCollider(id: Handle): void { this.withHandle(id, (at) => this.memory.call.singe_sim_remove_collider(this.sim, at)); }
    removePin(id: Handle): void { this.withHandle(id, (at) => this.memory.call.singe_sim_remove_pin(this.sim, at)); }

    moveSource(id: Handle, path: readonly Key[]): void {
        this.withHandle(id, (at) => this.memory.call.singe_sim_move_source(this.sim, at, path.length, keys(this.memory, path)));
    }
    moveCollider(id: Handle, path: readonly Key[]): void {
        this.withHandle(id, (at) => this.memory.call.singe_sim_move_collider(this.sim, at, path.length, keys(this.memory, path)));
    }
    /** Particles of a pin follow the new path from where they are. */
    movePin(id: Handle, path: readonly Key[]): void {
        this.withHandle(id, (at) => this.memory.call.singe_sim_move_pin(this.sim, at, path.length, keys(this.memory, path)));
    }

    setWind(wind: WindOptions): void {
        this.memory.during(() => {
            const def = this.def("wind");
            this.memory.write(def, "wind", wind);
            this.check(this.memory.call.singe_sim_set_wind(this.sim, def));
        });
    }
    setGravity(gravity: Vector): void {
        this.memory.during(() => this.check(this.memory.call.singe_sim_set_gravity(this.sim, this.memory.put(gravity))));
    }
    setPace(pace: number): void { this.check(this.memory.call.singe_sim_set_pace(this.sim, pace)); }

    // ---- stepping

    step(): void { this.check(this.memory.call.singe_sim_step(this.sim)); }

    /** As many steps as fit in `seconds` and the rest of earlier calls, but at most `most`: the number of them. */
    advance(seconds: number, most = 0): number {
        return this.memory.during(() => {
            const steps = this.memory.take(4);
            this.check(this.memory.call.singe_sim_advance(this.sim, seconds, most, steps));
            return this.memory.u32(steps);
        });
    }

    // ---- reading; arrays are windows on the module's memory, valid until the next call

    /** The particles: counts, and arrays such as position (four numbers each), temperature and mass. */
    view(): View { return this.struct("view", this.memory.call.singe_sim_read_view) as unknown as View; }
    /** The gas, or null without it. */
    gas(): Gas | null {
        const gas = this.struct("air", this.memory.call.singe_sim_read_gas) as unknown as Gas;
        return gas.size[0] ? gas : null;
    }
    stats(): Stats { return this.struct("stats", this.memory.call.singe_sim_read_stats) as unknown as Stats; }
    counts(): Counts { return this.struct("counts", this.memory.call.singe_sim_read_counts) as unknown as Counts; }

    /** The mesh to be drawn, cut where the sheet is gone. */
    draw(): Surface {
        const { memory, surface } = this;
        this.check(memory.call.singe_sim_draw(this.sim, surface, memory.size("surface")));
        return this.windows("surface", surface) as unknown as Surface;
    }

    /** Of the last step, or of all steps of the last advance(). */
    events(): SimulationEvent[] {
        const { memory } = this;
        return memory.during(() => {
            const place = memory.take(4), first = memory.call.singe_sim_events(this.sim, place);
            return Array.from({ length: memory.u32(place) }, (_, i) => {
                const event = memory.read(first + i * memory.size("event"), "event");
                return { ...event, kind: EVENTS[event.kind as number]! } as unknown as SimulationEvent;
            });
        });
    }

    /** The particles that a pin holds. */
    pinParticles(id: Handle): Uint32Array {
        const { memory } = this;
        return memory.during(() => {
            const count = memory.take(4), at = memory.call.singe_sim_pin_particles(this.sim, this.put(id), count);
            return new Uint32Array(memory.memory.buffer, at, memory.u32(count)).slice();
        });
    }

    /** The whole state, for Singe.restore. Handles stay valid. */
    save(): Uint8Array {
        const { memory } = this;
        return memory.during(() => {
            const place = memory.take(8);
            this.check(memory.call.singe_sim_save(this.sim, place, place + 4));
            const at = memory.u32(place), bytes = new Uint8Array(memory.memory.buffer, at, memory.u32(place + 4)).slice();
            memory.call.singe_sim_free_bytes(this.sim, at, bytes.length);
            return bytes;
        });
    }

    // ---- helpers

    private check(result: number): void {
        if (result) throw errorAt(this.memory, this.memory.call.singe_sim_error(this.sim));
    }

    private def(name: string): number {
        const def = this.memory.take(this.memory.size(name));
        this.memory.call[`singe_init_${name}`]!(def, this.memory.size(name));
        return def;
    }

    private put(id: Handle): number { return this.memory.put([id.index, id.generation], "uint32"); }

    private handle(call: (place: number) => number): Handle {
        const place = this.memory.take(8);
        this.check(call(place));
        return { index: this.memory.u32(place), generation: this.memory.u32(place + 4) };
    }

    private withHandle(id: Handle, call: (at: number) => number): void {
        this.memory.during(() => this.check(call(this.put(id))));
    }

    private struct(name: string, read: (...numbers: number[]) => number): object {
        return this.memory.during(() => {
            const at = this.memory.take(this.memory.size(name));
            read(this.sim, at, this.memory.size(name));
            return this.windows(name, at);
        });
    }

    private windows(name: string, at: number): object {
        const { memory } = this, found = memory.read(at, name);
        const cells = name === "air" ? (found.size as number[]).reduce((a, b) => a * b, 1) : undefined;
        return { ...found, ...Object.fromEntries(memory.arrays(name).map((key) => [key, memory.array(at, name, key, cells)])) };
    }
}

/** Where a sheet begins: turned about x, then y, then z, in radians, and then moved, in m. */
export interface Placement { rotate?: Vector; translate?: Vector }

/** Arrays have one entry for each particle, unless said otherwise (SingeView). */
export interface View {
    time: number; step: number; topology_version: number;
    particle_count: number; vertex_count: number; cell_count: number; spring_count: number[];
    position: Float32Array; velocity: Float32Array; rest_position: Float32Array; uv: Float32Array; mass: Float32Array;
    temperature: Float32Array; burn_rate: Float32Array; time_ignited: Float32Array; piece: Int32Array;
    /** bits: 1 alive, 2 pinned */
    particle_flags: Uint8Array; cell_flags: Uint8Array;
    cells: Uint32Array;
}

/** One entry for each vertex of the drawn mesh (SingeSurface). */
export interface Surface {
    vertex_count: number; triangle_count: number;
    position: Float32Array; normal: Float32Array; uv: Float32Array; velocity: Float32Array; rest_position: Float32Array;
    temperature: Float32Array; temperature_peak: Float32Array; mass: Float32Array; burn_rate: Float32Array;
    char_fraction: Float32Array; ash_fraction: Float32Array; burn: Float32Array; time_ignited: Float32Array;
    piece: Int32Array; source_vertex: Int32Array; sheet: Int32Array;
    triangles: Uint32Array;
}

/** Hot air, flames and smoke in cubes, x fastest (SingeGas). */
export interface Gas {
    size: [number, number, number]; origin: [number, number, number]; cell: number;
    /** K; kg/m3 of soot; W/m3; m/s */
    temperature: Float32Array; smoke: Float32Array; flame: Float32Array; velocity: Float32Array;
}

/** SingeStats; the main ones are named here. */
export interface Stats {
    time: number; particles: number; springs: number; cells: number; pieces: number; mass: number; mass_initial: number;
    burnt_fraction: number; temperature_max: number; strain_mean: number; strain_p99: number; strain_max: number;
    front_speed: number; tears: number; ledgers_close: boolean;
    arrival_error: number; arrival_missed: number; pace: number; water: number;
    [name: string]: number | boolean;
}

export interface Counts { particles: number; cells: number; springs: number[]; cell_size: number; memory: number; instructions: number }

function errorAt(memory: Memory, at: number): SingeError {
    const data = memory.data, element = Number(data.getBigInt64(memory.at(at, "error", "element"), true));
    return new SingeError(memory.text(memory.at(at, "error", "stage")), element, memory.text(memory.at(at, "error", "message")));
}

/** Turns positions about the axes, then moves them. */
function place(positions: Float32Array, rotate: Vector, translate: Vector): void {
    const axes = [[1, 2], [2, 0], [0, 1]] as const;
    for (let i = 0; i < positions.length; i += 3) {
        axes.forEach(([a, b], axis) => {
            const angle = rotate[axis]!, [c, s, x, y] = [Math.cos(angle), Math.sin(angle), positions[i + a]!, positions[i + b]!];
            if (!angle) return;
            positions[i + a] = c * x - s * y;
            positions[i + b] = s * x + c * y;
        });
        for (let k = 0; k < 3; k++) positions[i + k]! += translate[k]!;
    }
}

function keys(memory: Memory, path: readonly Key[]): number {
    return memory.put(path.flatMap(({ time, position, rotation }) => [time, ...position, ...(rotation ?? [0, 0, 0, 1])]));
}

function simDef(memory: Memory, options: SimulationOptions): number {
    const def = memory.take(memory.size("sim")), { wind, solver, gas, contact, ...rest } = options;
    const parts = { wind, solver, gas, contact };
    for (const part of Object.keys(parts))
        memory.data.setUint32(memory.at(def, "sim", part), memory.size(part), true); // its struct_size comes first
    memory.call.singe_init_sim(def, memory.size("sim"));
    for (const [part, given] of Object.entries(parts)) memory.write(memory.at(def, "sim", part), part, given ?? {});
    memory.write(def, "sim", rest);
    return def;
}

/** The cells of a grid, by the library. */
function gridQuads(memory: Memory, grid: Grid): Quads {
    const place = memory.take(4), error = memory.take(memory.size("error")), def = memory.take(memory.size("grid"));
    memory.call.singe_init_grid(def, memory.size("grid"));
    memory.write(def, "grid", grid);
    if (memory.call.singe_mesh_create_grid(def, place, error)) throw errorAt(memory, error);
    const mesh = memory.u32(place), view = memory.take(memory.size("meshview"));
    memory.call.singe_mesh_read(mesh, view, memory.size("meshview"));
    const [positions, cells, uv] = ["positions", "cells", "uv"].map((key) => memory.array(view, "meshview", key).slice());
    memory.call.singe_mesh_destroy(mesh);
    return { positions: positions!, cells: cells!, uv: uv! };
}

export { Files, loadFiles, type FileFaces, type FileQuads } from "./files.js";
export type { Numbers };
