// The module's memory: structs by the lists of layout.c, arrays, and room for the arguments of one call.
import { layout } from "./layout.js";

/** A field's type, how many numbers it has, its offset, and the enum of its words. */
type Field = readonly [type: string, length: number, offset: number, words?: string];
/** Numbers that a struct points to: their type, how many an element has, the pointer's offset, the field that counts elements. */
type ArrayField = readonly [type: string, width: number, offset: number, count: string];
interface Struct { size: number; fields: Record<string, Field | undefined>; arrays?: Record<string, ArrayField | undefined> }
export interface Layout { structs: Record<string, Struct | undefined>; words: Record<string, Record<string, number> | undefined> }

/** Bytes of numbers that have not four. */
const WIDE: Record<string, number> = { bool: 1, double: 8, uint64: 8 };
const ARRAYS = { float: Float32Array, int: Int32Array, uint32: Uint32Array, uint8: Uint8Array };

/** The functions of exports.txt. Pointers are numbers, and so are results; 64-bit integers are not used. */
export type Exports = Record<string, (...numbers: number[]) => number> & { malloc(size: number): number };
export type Numbers = Float32Array | Int32Array | Uint32Array | Uint8Array;

export class Memory {
    private room: number[] = [];

    constructor(readonly memory: WebAssembly.Memory, readonly call: Exports) {}

    // ---- numbers and strings

    get data(): DataView { return new DataView(this.memory.buffer); }
    u32(at: number): number { return this.data.getUint32(at, true); }

    text(at: number): string {
        const bytes = new Uint8Array(this.memory.buffer);
        let end = at;
        while (bytes[end]) end++;
        return new TextDecoder().decode(bytes.subarray(at, end));
    }

    // ---- room that lives until the call that it is for has returned

    /** Runs `work`, and then frees all that `take` and `put` have given it. */
    during<Result>(work: () => Result): Result {
        const before = this.room;
        this.room = [];
        try {
            return work();
        } finally {
            for (const at of this.room) this.call.free(at);
            this.room = before;
        }
    }

    /** Zeroed bytes until the end of `during`. */
    take(size: number): number {
        const at = this.call.malloc(Math.max(size, 8));
        if (!at) throw new RangeError("out of memory");
        this.room.push(at);
        new Uint8Array(this.memory.buffer, at, size).fill(0);
        return at;
    }

    put(numbers: ArrayLike<number>, kind: "float" | "uint32" | "int32" = "float"): number {
        const at = this.take(4 * numbers.length);
        const Kind = { float: Float32Array, uint32: Uint32Array, int32: Int32Array }[kind];
        new Kind(this.memory.buffer, at, numbers.length).set(numbers);
        return at;
    }

    putText(text: string): number {
        const bytes = new TextEncoder().encode(text), at = this.take(bytes.length + 1);
        new Uint8Array(this.memory.buffer, at, bytes.length).set(bytes);
        return at;
    }

    putTexture(at: number, where: string, { width, height, values }: { width: number; height: number; values: Float32Array }): void {
        if (values.length !== width * height) throw new TypeError(`${where}: ${width * height} values were expected`);
        this.write(at, "texture", { width, height, values: this.put(values) });
    }

    // ---- structs

    size(name: string): number { return this.struct(name).size; }
    at(struct: number, name: string, field: string): number { return struct + this.field(name, field)[2]; }

    /** Writes the options that are given; the others keep their values. An unknown key is an error. */
    write(struct: number, name: string, options: object): void {
        for (const [key, value] of Object.entries(options)) if (value !== undefined) this.set(struct, name, key, value);
    }

    set(struct: number, name: string, key: string, value: unknown): void {
        const [type, length, offset, enumeration] = this.field(name, key), words = enumeration === undefined ? undefined : layout.words[enumeration], many = length > 1;
        if (many && (!value || typeof value !== "object" || (value as unknown[]).length !== length))
            throw new TypeError(`${name}.${key}: a list of ${length} was expected`);
        const values = many ? Array.from(value as ArrayLike<unknown>) : [value];
        const step = type === "param" ? this.size("param") : WIDE[type] ?? 4;
        values.forEach((one, k) => this.setOne(struct + offset + k * step, `${name}.${key}`, type, words, one));
    }

    get(struct: number, name: string, key: string): number | number[] | boolean {
        const [type, length, offset] = this.field(name, key), data = this.data, step = WIDE[type] ?? 4;
        const one = (at: number): number => {
            if (type === "float") return data.getFloat32(at, true);
            if (type === "double") return data.getFloat64(at, true);
            if (type === "uint64") return Number(data.getBigUint64(at, true));
            return type === "int" ? data.getInt32(at, true) : data.getUint32(at, true);
        };
        if (type === "bool") return data.getUint8(struct + offset) !== 0;
        return length > 1 ? Array.from({ length }, (_, k) => one(struct + offset + k * step)) : one(struct + offset);
    }

    /** All numbers of a struct, by their names. */
    read(struct: number, name: string): Record<string, number | number[] | boolean> {
        return Object.fromEntries(Object.keys(this.struct(name).fields).map((key) => [key, this.get(struct, name, key)]));
    }

    /** An array that a struct points to: a window on the module's memory, valid until the next call. */
    array(struct: number, name: string, key: string, count?: number): Numbers {
        const field = this.struct(name).arrays?.[key];
        if (!field) throw new TypeError(`${name} has no array ${key}`);
        const [type, width, offset, counted] = field, at = this.u32(struct + offset);
        if (!at) return new Float32Array(0);
        return new ARRAYS[type as keyof typeof ARRAYS](this.memory.buffer, at, (count ?? this.u32(this.at(struct, name, counted))) * width);
    }

    /** The names of a struct's arrays. */
    arrays(name: string): string[] { return Object.keys(this.struct(name).arrays ?? {}); }

    // ---- layout.c

    private struct(name: string): Struct {
        const struct = layout.structs[name];
        if (!struct) throw new TypeError(`there is no struct ${name}`);
        return struct;
    }

    private field(name: string, key: string): Field {
        const { fields } = this.struct(name), field = Object.hasOwn(fields, key) && fields[key];
        if (!field) throw new TypeError(`${name} has no ${key}`);
        return field;
    }

    private setOne(at: number, where: string, type: string, words: Record<string, number> | undefined, value: unknown): void {
        const data = this.data;
        if (words) {
            if (!Object.hasOwn(words, value as string)) throw new TypeError(`${where}: one of ${Object.keys(words).join(", ")} was expected`);
            data.setInt32(at, words[value as string]!, true);
        } else if (type === "param") {
            this.setParam(at, where, value);
        } else if (type === "bool") {
            data.setUint8(at, value ? 1 : 0);
        } else if (typeof value !== "number" || Number.isNaN(value)) {
            throw new TypeError(`${where}: a number was expected`);
        } else if (type === "float") {
            data.setFloat32(at, value, true);
        } else if (type === "uint64") {
            data.setBigUint64(at, BigInt(Math.trunc(value)), true);
        } else {
            data.setInt32(at, value, true);
        }
    }

    /** SingeParam: a value, the value at the other end, and the field that leads from one to the other. */
    private setParam(at: number, where: string, value: unknown): void {
        if (typeof value === "number" && !Number.isNaN(value)) {
            this.data.setFloat32(at, value, true);
            this.data.setUint32(at + 8, 0, true);
            return;
        }
        const param = value as { from: number; to: number; noise?: object; texture?: { width: number; height: number; values: Float32Array } };
        if (!param || typeof param.from !== "number" || typeof param.to !== "number" || !(param.noise || param.texture))
            throw new TypeError(`${where}: a number, or {from, to, noise} or {from, to, texture}, was expected`);
        const field = this.take(this.size("field"));
        if (param.texture) {
            this.putTexture(this.at(field, "field", "texture"), where, param.texture);
            this.set(field, "field", "kind", 1);
        } else {
            const noise = { octaves: 1, seed: 1, ...param.noise };
            for (const [key, number] of Object.entries(noise)) this.set(field, "field", `noise.${key}`, number);
            this.set(field, "field", "kind", 3);
        }
        this.data.setFloat32(at, param.from, true);
        this.data.setFloat32(at + 4, param.to, true);
        this.data.setUint32(at + 8, field, true);
    }
}
