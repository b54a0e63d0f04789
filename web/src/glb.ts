// The sheet as it is, as a binary glTF 2.0 with its print, its temperature and its burn (docs/formats.md has the same names).
import { FLOATS } from "./fields.js";
import type { Frame } from "./messages.js";

/** @param print a PNG over uv */
export function glbOf({ vertices, triangles }: Pick<Frame, "vertices" | "triangles">, print: Uint8Array): Uint8Array<ArrayBuffer> {
    const count = vertices.length / FLOATS;
    const parts: { name: string; type: string; width: number; array: Float32Array | Uint32Array }[] = [];
    const pick = (name: string, type: string, width: number, value: (vertex: number, k: number) => number) => {
        const array = new Float32Array(width * count);
        for (let i = 0; i < count; i++) for (let k = 0; k < width; k++) array[width * i + k] = value(i, k);
        parts.push({ name, type, width, array });
    };
    const yUp = (at: number) => (i: number, k: number) => (k === 0 ? 1 : k === 1 ? 1 : -1) * vertices[FLOATS * i + at + [0, 2, 1][k]!]!;
    pick("POSITION", "VEC3", 3, yUp(0));
    pick("NORMAL", "VEC3", 3, (i, k) => {
        const length = Math.hypot(...vertices.subarray(FLOATS * i + 3, FLOATS * i + 6));
        return length > 0 ? yUp(3)(i, k) / length : k === 1 ? 1 : 0;
    });
    pick("TEXCOORD_0", "VEC2", 2, (i, k) => (k ? 1 - vertices[FLOATS * i + 10]! : vertices[FLOATS * i + 9]!));
    pick("COLOR_0", "VEC3", 3, (i) => Math.max(0.86 * Math.exp(-5 * vertices[FLOATS * i + 15]!), 0.014));
    pick("_TEMPERATURE", "SCALAR", 1, (i) => vertices[FLOATS * i + 11]!);
    pick("_BURN", "SCALAR", 1, (i) => vertices[FLOATS * i + 15]!);
    parts.push({ name: "", type: "SCALAR", width: 1, array: triangles });

    let length = 0;
    const begins: number[] = [];
    const views: object[] = parts.map(({ name, array }) => {
        begins.push(length);
        const view = { buffer: 0, byteOffset: length, byteLength: array.byteLength, target: name ? 34962 : 34963 };
        length += array.byteLength;
        return view;
    });
    views.push({ buffer: 0, byteOffset: length, byteLength: print.length });
    const printAt = length;
    length += Math.ceil(print.length / 4) * 4;
    const accessors = parts.map(({ name, type, width, array }, i) => ({
        bufferView: i, componentType: name ? 5126 : 5125, count: array.length / width, type, ...(name === "POSITION" ? boundsOf(array as Float32Array) : {}),
    }));
    const attributes = Object.fromEntries(parts.slice(0, -1).map(({ name }, i) => [name, i]));
    const json = {
        asset: { version: "2.0", generator: "Singe" }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0, name: "sheet" }],
        meshes: [{ primitives: [{ attributes, indices: parts.length - 1, material: 0 }] }],
        materials: [{ name: "paper", doubleSided: true, pbrMetallicRoughness: { baseColorTexture: { index: 0 }, metallicFactor: 0, roughnessFactor: 0.9 } }],
        images: [{ bufferView: parts.length, mimeType: "image/png" }], samplers: [{}], textures: [{ source: 0, sampler: 0 }],
        buffers: [{ byteLength: length }], bufferViews: views, accessors,
    };
    let text = new TextEncoder().encode(JSON.stringify(json));
    if (text.length % 4) text = new TextEncoder().encode(JSON.stringify(json) + " ".repeat(4 - (text.length % 4)));
    const out = new Uint8Array(28 + text.length + length), header = new DataView(out.buffer);
    [0x46546c67, 2, out.length, text.length, 0x4e4f534a].forEach((word, i) => header.setUint32(4 * i, word, true));
    out.set(text, 20);
    header.setUint32(20 + text.length, length, true);
    header.setUint32(24 + text.length, 0x004e4942, true);
    parts.forEach(({ array }, i) => out.set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength), 28 + text.length + begins[i]!));
    out.set(print, 28 + text.length + printAt);
    return out;
}

function boundsOf(array: Float32Array) {
    const min = [Infinity, Infinity, Infinity], max = [-Infinity, -Infinity, -Infinity];
    array.forEach((x, i) => {
        min[i % 3] = Math.min(min[i % 3]!, x);
        max[i % 3] = Math.max(max[i % 3]!, x);
    });
    return { min, max };
}
