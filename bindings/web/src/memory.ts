// The module's memory: structs by the lists of layout.c, arrays, and room for the arguments of one call.

type Words = Map<string, number>;

interface Field { words: Words | null; type: number; length: number; offset: number }
interface ArrayField { type: number; width: number; offset: number; count: number }
interface Struct { size: number; fields: Map<string, Field>; arrays: Map<string, ArrayField> }

// enum of layout.c
const FLOAT = 0, INT = 1, UINT32 = 2, UINT64 = 3, BOOL = 4, PARAM = 5, DOUBLE = 6, INT32 = 7, UINT8 = 8;

/** The functions of exports.txt. Pointers are numbers, and so are results; 64-bit integers are not used. */
export type Exports = Record<string, (...numbers: number[]) => number> & { malloc(size: number): number };
export type Numbers = Float32Array | Int32Array | Uint32Array | Uint8Array;

export class Memory {
    private structs = new Map<string, Struct>();
    private room: number[] = [];

    constructor(readonly memory: WebAssembly.Memory, readonly call: Exports) {
        this.readLayout();
    }

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

    // ---- structs

    size(name: string): number { return this.struct(name).size; }
    at(struct: number, name: string, field: string): number { return struct + this.field(name, field).offset; }

    /** Writes the options that are given; the others keep their values. An unknown key is an error. */
    write(struct: number, name: string, options: object): void {
        for (const [key, value] of Object.entries(options)) if (value !== undefined) this.set(struct, name, key, value);
    }

    set(struct: number, name: string, key: string, value: unknown): void {
        const field = this.field(name, key), many = field.length > 1;
        if (many && (!value || typeof value !== "object" || (value as unknown[]).length !== field.length))
            throw new TypeError(`${name}.${key}: a list of ${field.length} was expected`);
        const values = many ? Array.from(value as ArrayLike<unknown>) : [value];
        const step = field.type === PARAM ? this.size("param") : field.type === UINT64 ? 8 : field.type === BOOL ? 1 : 4;
        values.forEach((one, k) => this.setOne(struct + field.offset + k * step, `${name}.${key}`, field, one));
    }

    get(struct: number, name: string, key: string): number | number[] | boolean {
        const field = this.field(name, key), data = this.data, at = struct + field.offset;
        const one = (k: number): number => {
            if (field.type === FLOAT) return data.getFloat32(at + 4 * k, true);
            if (field.type === DOUBLE) return data.getFloat64(at + 8 * k, true);
            if (field.type === UINT64) return Number(data.getBigUint64(at + 8 * k, true));
            return field.type === INT ? data.getInt32(at + 4 * k, true) : data.getUint32(at + 4 * k, true);
        };
        if (field.type === BOOL) return data.getUint8(at) !== 0;
        return field.length > 1 ? Array.from({ length: field.length }, (_, k) => one(k)) : one(0);
    }

    /** All numbers of a struct, by their names. */
    read(struct: number, name: string): Record<string, number | number[] | boolean> {
        return Object.fromEntries([...this.struct(name).fields.keys()].map((key) => [key, this.get(struct, name, key)]));
    }

    /** An array that a struct points to: a window on the module's memory, valid until the next call. */
    array(struct: number, name: string, key: string, count?: number): Numbers {
        const field = this.struct(name).arrays.get(key);
        if (!field) throw new TypeError(`${name} has no array ${key}`);
        const length = (count ?? this.u32(struct + field.count)) * field.width, at = this.u32(struct + field.offset);
        if (!at) return new Float32Array(0);
        const Kind = field.type === INT32 ? Int32Array : field.type === UINT32 ? Uint32Array : field.type === UINT8 ? Uint8Array
            : Float32Array;
        return new Kind(this.memory.buffer, at, length);
    }

    /** The names of a struct's arrays. */
    arrays(name: string): string[] { return [...this.struct(name).arrays.keys()]; }

    // ---- layout.c

    private struct(name: string): Struct {
        const struct = this.structs.get(name);
        if (!struct) throw new TypeError(`there is no struct ${name}`);
        return struct;
    }

    private field(name: string, key: string): Field {
        const field = this.struct(name).fields.get(key);
        if (!field) throw new TypeError(`${name} has no ${key}`);
        return field;
    }

    private setOne(at: number, where: string, field: Field, value: unknown): void {
        const data = this.data;
        if (field.words) {
            const number = field.words.get(value as string);
            if (number === undefined) throw new TypeError(`${where}: one of ${[...field.words.keys()].join(", ")} was expected`);
            data.setInt32(at, number, true);
        } else if (field.type === PARAM) {
            this.setParam(at, where, value);
        } else if (field.type === BOOL) {
            data.setUint8(at, value ? 1 : 0);
        } else if (typeof value !== "number" || Number.isNaN(value)) {
            throw new TypeError(`${where}: a number was expected`);
        } else if (field.type === FLOAT) {
            data.setFloat32(at, value, true);
        } else if (field.type === UINT64) {
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
            const texture = this.at(field, "field", "texture"), { width, height, values } = param.texture;
            if (values.length !== width * height) throw new TypeError(`${where}: ${width * height} values were expected`);
            this.write(texture, "texture", { width, height, values: this.put(values) });
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

    private readLayout(): void {
        const layout = this.call.layout(), words = new Map<string, Words>();
        const rows = (list: number, size: number): number[] =>
            Array.from({ length: this.u32(layout + 8 * list + 4) }, (_, i) => this.u32(layout + 8 * list) + i * size);
        for (const row of rows(3, 8))
            this.structs.set(this.text(this.u32(row)), { size: this.u32(row + 4), fields: new Map(), arrays: new Map() });
        for (const row of rows(2, 12)) {
            const of = this.text(this.u32(row)), known = words.get(of) ?? new Map<string, number>();
            known.set(this.text(this.u32(row + 4)), this.u32(row + 8));
            words.set(of, known);
        }
        for (const row of rows(0, 24)) {
            const enumeration = this.u32(row + 8);
            this.struct(this.text(this.u32(row))).fields.set(this.text(this.u32(row + 4)), {
                words: enumeration ? words.get(this.text(enumeration)) ?? null : null,
                type: this.u32(row + 12), length: this.u32(row + 16), offset: this.u32(row + 20),
            });
        }
        for (const row of rows(1, 24))
            this.struct(this.text(this.u32(row))).arrays.set(this.text(this.u32(row + 4)), {
                type: this.u32(row + 8), width: this.u32(row + 12), offset: this.u32(row + 16), count: this.u32(row + 20),
            });
    }
}
