// Files of meshes in, USD out, by the readers and the writer of the command `singe` (files.c): a module of its own, which
// is needed only when a file comes or goes.
import type { Exports } from "./memory.js";
import type { Faces, Quads, Surface } from "./index.js";

/** The fields of SingeSurface, in its order. */
const FIELDS = [
    "position", "normal", "uv", "velocity", "rest_position", "temperature", "temperature_peak", "mass", "burn_rate", "char_fraction", "ash_fraction", "burn",
    "time_ignited", "piece", "source_vertex", "sheet", "triangles",
] as const;

export interface FileFaces extends Faces { positions: Float32Array; corners: Uint32Array; sizes: Uint32Array; corner_uv?: Float32Array }

export interface FileQuads extends Quads { positions: Float32Array; cells: Uint32Array; uv?: Float32Array; corner_uv?: Float32Array }

export class Files {
    constructor(private readonly module: WebAssembly.Module) {}

    /**
     * Reads OBJ, PLY, STL or GLB, as the ending of the name says. What is wrong is thrown with its line or byte. Units and
     * axes are the file's.
     */
    readMesh(name: string, bytes: Uint8Array): FileFaces {
        const { put, room, call, words } = this.begin(), out = room(28);
        fail(words, call.files_read_mesh!(put(new TextEncoder().encode(`${name}\0`)), put(bytes), bytes.length, out));
        const [vertices, faces, corners, position, first, corner, uv] = words(out, 7) as unknown as [number, number, number, number, number, number, number];
        const begins = words(first, faces + 1);
        return {
            positions: floats(words(position, 3 * vertices)), corners: words(corner, corners).slice(),
            sizes: Uint32Array.from({ length: faces }, (_, i) => begins[i + 1]! - begins[i]!), ...(uv ? { corner_uv: floats(words(uv, 2 * corners)) } : {}),
        };
    }

    /** Faces of any kind as the cells of a sheet (docs/meshes.md): repaired, or refused with the face that is wrong. */
    quads({ positions, corners, sizes, uv, corner_uv }: Faces): FileQuads {
        const { put, room, call, words } = this.begin(), out = room(28), real = (list?: ArrayLike<number>) => (list ? put(bytesOf(Float32Array.from(list))) : 0);
        const given = [positions.length / 3, sizes ? sizes.length : corners.length / 3, real(positions), put(bytesOf(Uint32Array.from(corners))),
            sizes ? put(bytesOf(Uint32Array.from(sizes))) : 0, real(uv), real(corner_uv)];
        words(out, 7).set(given); // now that the memory grows no more
        fail(words, call.files_make_quads!(out));
        const [vertices, cells, position, cell, flat, seams] = words(out, 6) as unknown as [number, number, number, number, number, number];
        return {
            positions: floats(words(position, 3 * vertices)), cells: words(cell, 4 * cells).slice(),
            ...(flat ? { uv: floats(words(flat, 2 * vertices)) } : {}), ...(seams ? { corner_uv: floats(words(seams, 8 * cells)) } : {}),
        };
    }

    /** A drawn surface of one sheet as a USDC file, with all its fields. `name` is its prim's; `colour` is linear. */
    writeUsdc(surface: Surface, name = "singe", colour: readonly [number, number, number] = [1, 1, 1]): Uint8Array<ArrayBuffer> {
        const { put, room, call, words } = this.begin(), places = FIELDS.map((field) => put(bytesOf(surface[field])));
        const text = put(new TextEncoder().encode(`${name}\0`)), tint = put(bytesOf(Float32Array.from(colour))), def = room(4 * (3 + FIELDS.length));
        words(def, 3 + FIELDS.length).set([surface.vertex_count, surface.triangle_count, 0, ...places]);
        fail(words, call.files_write_usdc!(text, tint, def));
        const [at, size] = words(def, 2) as unknown as [number, number];
        return new Uint8Array(words(at, 0).buffer, at, size).slice();
    }

    /** An instance for one call: a hostile file leaves nothing behind. */
    private begin() {
        const none = () => 8, instance = new WebAssembly.Instance(this.module, { wasi_snapshot_preview1: { fd_close: none, fd_seek: none, fd_write: none } });
        const call = instance.exports as unknown as Exports & { memory: WebAssembly.Memory };
        call._initialize!();
        const room = (size: number): number => {
            const at = call.malloc(Math.max(size, 8));
            if (!at) throw new RangeError("out of memory");
            return at;
        };
        const put = (bytes: Uint8Array): number => {
            const at = room(bytes.length);
            new Uint8Array(call.memory.buffer, at, bytes.length).set(bytes);
            return at;
        };
        return { call, room, put, words: (at: number, count: number) => new Uint32Array(call.memory.buffer, at, count) };
    }
}

/** Compiles singe-files.wasm: its address, a response, or its bytes. */
export async function loadFiles(source: URL | string | BufferSource | Response | Promise<Response>): Promise<Files> {
    const given = await source, bytes = typeof given === "string" || given instanceof URL ? await fetch(given) : given;
    if (bytes instanceof ArrayBuffer || ArrayBuffer.isView(bytes)) return new Files(await WebAssembly.compile(bytes as BufferSource));
    return new Files(await WebAssembly.compileStreaming(bytes as Response));
}

const floats = (words: Uint32Array) => new Float32Array(words.slice().buffer);
const bytesOf = (array: Float32Array | Int32Array | Uint32Array) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength);

function fail(words: (at: number, count: number) => Uint32Array, message: number): void {
    if (!message) return;
    const bytes = new Uint8Array(words(0, 0).buffer, message);
    throw new Error(new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0))));
}
