// Draws a frame by WebGL 2: ground, sheets and shapes in the scene's light, then fire, a lens's halo and the film's curve,
// with the shaders of the page; or one field of the sheets by colour.
import { Card, GAP } from "./card.js";
import { gapsOf } from "./contact.js";
import { DAY, GROUND_PLAIN, GROUND_WOOD, LIGHTS, SHAPE, SHEET_VERTEX, WALL } from "./daylight.js";
import { Flying } from "./flying.js";
import { FIELDS, VERTEX_BYTES } from "./frame.js";
import { flameScale, refineGas } from "./gas.js";
import { FIELD, FIELD_GROUND, hex, LAYERS, ramp, SLICE, STRAND, STRAND_VERTEX, TABLE } from "./layers.js";
import { add, apply, cross, dot, invert, length, lookAt, multiply, orthographic, perspective, placed, unit } from "./math.js";
import * as glsl from "./shaders.js";
import { box, sphere } from "./solids.js";
import { COLOURS, placesOf } from "./strands.js";
import { FLAME_NOISE, flameNoiseBytes, glowBytes, noiseBytes, sliceBytes } from "./tables.js";

const SHADOW = 2048;
const COPY = /* glsl */ `precision highp float;
in vec2 at;
uniform sampler2D map;
out vec4 colour;
void main() { colour = texture(map, at); }`;

export class Stage extends Card {
    /** @param {HTMLCanvasElement} canvas */
    constructor(canvas) {
        super(canvas);
        const { gl } = this;
        this.layer = "paper";
        this.slice = 0.5;
        this.fire = true;
        this.programs = {
            wood: this.program(glsl.PLAIN_VERTEX, GROUND_WOOD), plain: this.program(glsl.PLAIN_VERTEX, GROUND_PLAIN), wall: this.program(glsl.PLAIN_VERTEX, WALL), shape: this.program(glsl.PLAIN_VERTEX, SHAPE),
            paper: this.program(SHEET_VERTEX, glsl.paper(DAY)), caster: this.program(SHEET_VERTEX, `#define SHADOW\n${glsl.paper(DAY)}`), field: this.program(SHEET_VERTEX, FIELD), slice: this.program(glsl.PLAIN_VERTEX, SLICE), grid: this.program(glsl.PLAIN_VERTEX, FIELD_GROUND),
            strand: this.program(STRAND_VERTEX, STRAND), flying: this.program(glsl.AIRBORNE_VERTEX, glsl.airborne(DAY)), fire: this.program(glsl.FULL_VERTEX, glsl.FIRE), bright: this.program(glsl.FULL_VERTEX, glsl.BRIGHT),
            blur: this.program(glsl.FULL_VERTEX, glsl.BLUR), film: this.program(glsl.FULL_VERTEX, glsl.FILM), copy: this.program(glsl.FULL_VERTEX, COPY),
        };
        const { side, bytes } = noiseBytes(), glow = glowBytes();
        this.noise = this.texture3d(side, side, side, bytes, gl.REPEAT);
        this.flameNoise = this.texture3d(FLAME_NOISE, FLAME_NOISE, FLAME_NOISE, flameNoiseBytes().bytes, gl.REPEAT);
        this.slices = this.texture3d(side, side, 4, sliceBytes().bytes, gl.REPEAT, gl.TEXTURE_2D_ARRAY);
        this.glow = this.texture2d(glow.width, 2, gl.RGBA16F, gl.RGBA, gl.FLOAT, glow.values);
        this.ramps = Object.fromEntries(Object.entries(LAYERS).map(([name, layer]) => [name, this.texture2d(256, 1, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, ramp(layer))]));
        this.white = this.texture2d(1, 1, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array([255, 255, 255, 255]));
        this.quad = this.mesh([-1, -1, 0, 0, 0, 1, 1, -1, 0, 0, 0, 1, 1, 1, 0, 0, 0, 1, -1, 1, 0, 0, 0, 1], [0, 1, 2, 0, 2, 3]);
        this.kinds = { 1: this.mesh(...sphere()), 2: this.mesh(...box()) };
        this.flying = new Flying(this, this.programs.flying);
        this.solids = new Map();
        this.pictures = [];
        this.sheets = { array: gl.createVertexArray(), vertices: gl.createBuffer(), triangles: gl.createBuffer(), gaps: gl.createBuffer(), runs: [] };
        this.shadowMap = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, this.shadowMap);
        gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, SHADOW, SHADOW);
        for (const [name, value] of [["TEXTURE_MIN_FILTER", gl.LINEAR], ["TEXTURE_MAG_FILTER", gl.LINEAR], ["TEXTURE_COMPARE_MODE", gl.COMPARE_REF_TO_TEXTURE], ["TEXTURE_COMPARE_FUNC", gl.LEQUAL]])
            gl.texParameteri(gl.TEXTURE_2D, gl[name], value);
        this.shadowFrame = gl.createFramebuffer();
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowFrame);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.shadowMap, 0);
        this.resize(canvas.width, canvas.height);
    }

    resize(width, height) {
        const { gl } = this, w = Math.max(width, 2), h = Math.max(height, 2), half = Math.ceil(w / 2), quarter = Math.ceil(w / 4);
        this.canvas.width = w;
        this.canvas.height = h;
        this.target("scene", w, h);
        this.target("fire", half, Math.ceil(h / 2));
        for (const name of ["bright", "across", "halo", "glare", "haze"]) this.target(name, quarter, Math.ceil(h / 4));
        for (const old of [this.colourBuffer, this.depthBuffer]) if (old) gl.deleteRenderbuffer(old);
        for (const old of [this.many, this.depthFrame]) if (old) gl.deleteFramebuffer(old);
        if (this.depth) gl.deleteTexture(this.depth);
        const samples = Math.min(4, gl.getParameter(gl.MAX_SAMPLES));
        this.colourBuffer = gl.createRenderbuffer();
        gl.bindRenderbuffer(gl.RENDERBUFFER, this.colourBuffer);
        gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, gl.RGBA16F, w, h);
        this.depthBuffer = gl.createRenderbuffer();
        gl.bindRenderbuffer(gl.RENDERBUFFER, this.depthBuffer);
        gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, gl.DEPTH_COMPONENT24, w, h);
        this.many = gl.createFramebuffer();
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.many);
        gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.RENDERBUFFER, this.colourBuffer);
        gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, this.depthBuffer);
        this.depth = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, this.depth);
        gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, w, h);
        for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
        this.depthFrame = gl.createFramebuffer();
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.depthFrame);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.depth, 0);
    }

    // ---- a run and its frames

    /** @param room what the server says of light, ground and sheets @param pictures of all sheets, then of their backs */
    setRoom(room, pictures) {
        const { gl } = this;
        for (const one of this.pictures) for (const texture of [one.texture, one.back]) if (texture !== this.white) gl.deleteTexture(texture);
        for (const { array } of this.solids.values()) gl.deleteVertexArray(array);
        this.solids.clear();
        this.room = room;
        this.frame = null;
        this.cells = null;
        const made = (picture) => (picture ? this.texture2d(picture.width, picture.height, gl.SRGB8_ALPHA8, gl.RGBA, gl.UNSIGNED_BYTE, picture.rgba, true) : this.white);
        this.pictures = room.sheets.map((sheet, i) => ({
            ...sheet, texture: made(pictures[i]), back: made(pictures[i + room.sheets.length]), dyed: sheet.cloth ? (sheet.back ? 0.5 : 1) : 0,
        }));
    }

    show(frame) {
        const { gl, sheets } = this;
        this.frame = frame;
        gl.bindVertexArray(sheets.array);
        gl.bindBuffer(gl.ARRAY_BUFFER, sheets.vertices);
        gl.bufferData(gl.ARRAY_BUFFER, frame.vertices, gl.STREAM_DRAW);
        FIELDS.forEach(([name, size, type, at], i) => {
            gl.enableVertexAttribArray(i);
            gl.vertexAttribPointer(i, size, gl[type], type !== "FLOAT" && name !== "sheet", VERTEX_BYTES, at);
        });
        gl.disableVertexAttribArray(GAP);
        sheets.contactOf = null;
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, sheets.triangles);
        gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, frame.triangles, gl.STREAM_DRAW);
        gl.bindVertexArray(null);

        // the triangles of each sheet follow each other
        sheets.runs = [];
        const { triangles, vertices } = frame, sheetOf = (t) => vertices[VERTEX_BYTES * triangles[t] + 15];
        for (let t = 0, last = -1; t < triangles.length; t += 3) {
            const sheet = sheetOf(t);
            if (sheet !== last) sheets.runs.push({ sheet, first: t, count: 0 });
            sheets.runs[sheets.runs.length - 1].count += 3;
            last = sheet;
        }
        if (this.gas) gl.deleteTexture(this.gas);
        const gas = frame.gas && refineGas(frame.gas.size, frame.gas.cells);
        this.gas = gas && this.texture3d(...gas.size, gas.cells, gl.CLAMP_TO_EDGE);
    }

    /** The matrix of a camera {eye, target, up, fov}, which sees the whole of the scene's picture. */
    matrices({ eye, target, up, fov }) {
        const aspect = this.canvas.width / this.canvas.height, wanted = this.room ? this.room.width / this.room.height : aspect;
        const angle = aspect < wanted ? 2 * Math.atan((Math.tan(fov / 2) * wanted) / aspect) : fov, far = length(add(eye, target, -1));
        const frame = this.frame, spread = frame ? length(add(frame.high, frame.low, -1)) : 1;
        return multiply(perspective(angle, aspect, Math.max(0.004 * far, 1e-4), 40 * far + 4 * spread), lookAt(eye, target, up));
    }

    sunView() {
        const { frame, room } = this;
        let low = frame.low, high = frame.high;
        for (const { position, half, radius, height, kind } of frame.shapes) {
            const r = kind === 2 ? length(half) : kind === 1 || kind === 3 ? radius + height / 2 : 0;
            low = low.map((x, c) => Math.min(x, position[c] - r));
            high = high.map((x, c) => Math.max(x, position[c] + r));
        }
        const middle = add(low, high).map((x) => x / 2), size = length(add(high, low, -1)) + 0.02;
        const up = Math.abs(room.towards[2]) > 0.95 ? [0, 1, 0] : [0, 0, 1];
        return { matrix: multiply(orthographic(1.1 * size, 1.1 * size, 0, 4 * size), lookAt(add(middle, room.towards, 2 * size), middle, up)), size: 1.1 * size };
    }

    draw(camera) {
        const { gl, frame, room } = this;
        if (!frame || !room) return;
        const matrix = this.matrices(camera), sun = this.sunView(), paper = this.layer === "paper", reach = 9 * length(add(room.eye, room.target, -1));
        const places = new Float32Array(4 * LIGHTS), strengths = new Float32Array(4 * LIGHTS);
        for (let k = 0; k < frame.lightCount; k++) {
            places.set(frame.lights.subarray(8 * k, 8 * k + 4), 4 * k);
            strengths.set(frame.lights.subarray(8 * k + 4, 8 * k + 7), 4 * k);
        }
        const soft = Math.min(Math.max((Math.tan(room.sun_angle) * 0.10) / sun.size, 1.2 / SHADOW), 0.02);
        const shared = {
            viewProjection: matrix, eye: camera.eye, noiseMap: this.noise, sliceMap: this.slices, glowMap: this.glow, time: frame.time % 1000, sunTo: room.towards, sunLight: room.sun,
            ambient: room.ambient, lampView: sun.matrix, shadowMap: this.shadowMap, soft, lampPlace: places, lampStrength: strengths, lampCount: frame.lightCount,
            groundColour: room.ground_colour, background: room.background, reach, stone: room.ground === 1 ? 1 : 0,
        };

        if (this.layer === "contact") this.findContact();
        gl.disable(gl.BLEND);
        gl.disable(gl.CULL_FACE);
        gl.enable(gl.DEPTH_TEST);
        if (paper && this.shadowOf !== frame) { // a turned view has the same shadows
            this.shadowOf = frame;
            gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowFrame);
            gl.viewport(0, 0, SHADOW, SHADOW);
            gl.clear(gl.DEPTH_BUFFER_BIT);
            const cast = { ...shared, viewProjection: sun.matrix, shadowMap: null };
            this.drawSheets("caster", cast);
            this.drawShapes(cast);
        }
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.many);
        gl.viewport(0, 0, this.canvas.width, this.canvas.height);
        const back = paper ? room.background : [0.062, 0.056, 0.052];
        gl.clearColor(back[0], back[1], back[2], 1);
        gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
        if (this.layer === "strands") gl.enable(gl.POLYGON_OFFSET_FILL); // the springs stand out of the sheet
        gl.polygonOffset(4, 4);
        this.drawSheets(paper ? "paper" : "field", shared);
        gl.disable(gl.POLYGON_OFFSET_FILL);
        this.drawShapes(shared);
        if (room.ground_height !== null) {
            const s = 3 * reach;
            this.use(this.programs[!paper ? "grid" : room.ground === 0 ? "wood" : "plain"], { ...shared, modelMatrix: placed([camera.target[0], camera.target[1], room.ground_height - 1e-4], [0, 0, 0, 1], [s, s, 1]) });
            this.drawMesh(this.quad);
        }
        if (room.wall_distance !== null && paper) this.drawWall({ ...shared, reach }, 3 * reach);

        if (paper && this.fire) this.flying.draw(this, shared);
        if (this.layer === "gas" && frame.gas) this.drawSlice(camera, matrix);
        if (this.layer === "strands" && this.cells) this.drawStrands(camera, matrix);

        const { scene } = this.targets;
        const copy = (to, bits) => {
            gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.many);
            gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, to);
            gl.blitFramebuffer(0, 0, scene.width, scene.height, 0, 0, scene.width, scene.height, bits, gl.NEAREST);
        };
        copy(scene.frame, gl.COLOR_BUFFER_BIT);
        gl.disable(gl.DEPTH_TEST);
        if (!paper) {
            this.pass("copy", null, { map: scene.texture });
            return;
        }
        copy(this.depthFrame, gl.DEPTH_BUFFER_BIT);
        this.drawFire(camera, matrix, shared);
        const { fire, bright, across, halo, glare, haze } = this.targets, seen = { sceneMap: scene.texture, fireMap2: fire.texture, exposure: room.exposure };
        this.pass("bright", bright, { ...seen, pixel: [1 / scene.width, 1 / scene.height] });
        for (const [to, sigma] of [[halo, 0.005], [glare, 0.022], [haze, 0.065]]) {
            const wide = Math.max((sigma * scene.height) / 4, 0.5);
            this.pass("blur", across, { map: bright.texture, along: [1 / bright.width, 0], sigma: wide });
            this.pass("blur", to, { map: across.texture, along: [0, 1 / bright.height], sigma: wide });
        }
        this.pass("film", null, { ...seen, halo: halo.texture, glare: glare.texture, haze: haze.texture, vignette: 0, resolution: [scene.width, scene.height] });
    }

    /** An upright plane across the look, `this.slice` of the way through the gas. */
    drawSlice({ eye, target, up }, viewProjection) {
        const { gl } = this, { size, cell, corner } = this.frame.gas, span = size.map((n) => n * cell), middle = add(corner, span, 0.5);
        const level = (v) => unit(add(v, up, -dot(v, up))), ahead = level(add(target, eye, -1)), right = cross(ahead, up);
        const reach = (axis) => axis.reduce((sum, a, c) => sum + 0.5 * span[c] * Math.abs(a), 0);
        const centre = add(middle, ahead, (2 * this.slice - 1) * reach(ahead)), columns = [[right, reach(right)], [up, reach(up)], [ahead, 1]];
        gl.enable(gl.BLEND);
        gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ZERO, gl.ONE);
        gl.depthMask(false);
        const modelMatrix = Float32Array.from([...columns.flatMap(([axis, s]) => [...axis.map((a) => a * s), 0]), ...centre, 1]);
        this.use(this.programs.slice, { viewProjection, modelMatrix, fireMap: this.gas, colours: this.ramps.gas, origin: corner, span });
        this.drawMesh(this.quad);
        gl.depthMask(true);
        gl.disable(gl.BLEND);
    }

    /** @param cells of readCells: the sheets at rest */
    setCells(cells) {
        const { gl } = this, table = (inner, format, type, values) => {
            const rows = Math.max(Math.ceil(values.length / 4 / TABLE), 1), whole = new values.constructor(4 * TABLE * rows);
            whole.set(values);
            const texture = this.texture2d(TABLE, rows, inner, format, type, whole);
            for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
            return texture;
        };
        const bars = cells.ends.map((ends) => {
            const array = gl.createVertexArray(), place = gl.getAttribLocation(this.programs.strand.program, "ends");
            gl.bindVertexArray(array);
            gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
            gl.bufferData(gl.ARRAY_BUFFER, ends, gl.STATIC_DRAW);
            gl.enableVertexAttribArray(place);
            gl.vertexAttribIPointer(place, 2, gl.UNSIGNED_INT, 8, 0);
            gl.vertexAttribDivisor(place, 1);
            gl.bindVertexArray(null);
            return { array, count: ends.length / 2 };
        });
        this.cells = { cells, bars, map: table(gl.RGBA32UI, gl.RGBA_INTEGER, gl.UNSIGNED_INT, cells.cells), table };
    }

    drawStrands(camera, viewProjection) {
        const { gl, cells: { cells, bars, map, table }, canvas } = this, places = table(gl.RGBA32F, gl.RGBA, gl.FLOAT, placesOf(cells, this.frame));
        bars.forEach(({ array, count }, colour) => {
            const tint = hex(COLOURS[colour][0]).map((part) => part / 255);
            this.use(this.programs.strand, {
                places, cellMap: map, vertexCount: cells.vertexCount, viewProjection, eye: camera.eye, resolution: [canvas.width, canvas.height], thick: (1.7 * canvas.width) / canvas.clientWidth, tint,
            });
            gl.bindVertexArray(array);
            gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
        });
        gl.bindVertexArray(null);
        gl.deleteTexture(places);
    }

    /** Gives the card how near the frame's vertices come to something. */
    findContact() {
        const { gl, frame, room, sheets } = this;
        if (sheets.contactOf === frame) return;
        sheets.contactOf = frame;
        const solids = frame.shapes.flatMap((shape, i) => {
            const solid = this.solids.get(this.solidKey(i)), pose = placed(shape.position, shape.rotation, [1, 1, 1]);
            if (!shape.solid || !solid) return [];
            const positions = new Float32Array(solid.points.length);
            for (let k = 0; k < positions.length; k += 3) positions.set(apply(pose, solid.points.subarray(k, k + 3)), k);
            return [{ positions, triangles: solid.triangles }];
        });
        gl.bindVertexArray(sheets.array);
        gl.bindBuffer(gl.ARRAY_BUFFER, sheets.gaps);
        frame.gaps ??= gapsOf(frame, room.ground_height, solids);
        gl.bufferData(gl.ARRAY_BUFFER, frame.gaps, gl.STREAM_DRAW);
        gl.enableVertexAttribArray(GAP);
        gl.vertexAttribPointer(GAP, 1, gl.UNSIGNED_BYTE, true, 1, 0);
        gl.bindVertexArray(null);
    }

    drawSheets(program, shared) {
        const { gl, sheets } = this, layer = LAYERS[this.layer === "gas" ? "char" : this.layer];
        for (const { sheet, first, count } of sheets.runs) {
            const look = this.pictures[sheet] ?? { texture: this.white, back: this.white, colour: [1, 1, 1], transmittance: 0.19, dyed: 0 };
            const more = program !== "field" ? { printMap: look.texture, backMap: look.back, tint: look.colour, transmittance: look.transmittance, dyed: look.dyed }
                : { colours: this.ramps[this.layer === "gas" ? "char" : this.layer], range: [layer.index, layer.low, layer.high] };
            this.use(this.programs[program], { ...shared, ...more });
            gl.bindVertexArray(sheets.array);
            gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 4 * first);
        }
    }

    drawShapes(shared) {
        const capsule = (shape) => {
            const key = `capsule ${shape.height / shape.radius}`;
            if (!this.solids.has(key)) this.solids.set(key, this.mesh(...sphere(shape.height / 2 / shape.radius)));
            return this.solids.get(key);
        };
        this.frame.shapes.forEach((shape, i) => {
            const mesh = shape.kind === 3 ? capsule(shape) : shape.solid ? this.solids.get(this.solidKey(i)) : this.kinds[shape.kind];
            if (!mesh) return;
            const size = shape.kind === 2 ? shape.half : shape.kind === 1 || shape.kind === 3 ? [shape.radius, shape.radius, shape.radius] : [1, 1, 1];
            const turn = shape.kind === 1 ? [0, 0, 0, 1] : shape.rotation, grain = shape.solid ? [35, 35, 35] : size.map((half) => (3.5 * half) / size[0]);
            this.use(this.programs.shape, { ...shared, modelMatrix: placed(shape.position, turn, size), albedo: shape.colour, grain, kelvin: this.layer === "paper" ? shape.temperature : 0 });
            this.drawMesh(mesh);
        });
    }

    solidKey(i) { return this.frame.shapes[i].solid === 2 ? `${this.frame.time} ${i}` : `${i}`; }

    /** The triangles of a shape that is a mesh, with flat normals where edges are sharp. */
    addSolid(i, buffer) {
        this.shadowOf = null;
        const [vertices, triangles] = new Uint32Array(buffer, 0, 2), p = new Float32Array(buffer, 8, 3 * vertices), index = new Uint32Array(buffer, 8 + 12 * vertices, 3 * triangles);
        const at = (k) => [p[3 * k], p[3 * k + 1], p[3 * k + 2]], sums = new Float32Array(3 * vertices), flat = [];
        for (let t = 0; t < index.length; t += 3) {
            const a = at(index[t]), n = cross(add(at(index[t + 1]), a, -1), add(at(index[t + 2]), a, -1));
            flat.push(n);
            for (let k = 0; k < 3; k++) for (let c = 0; c < 3; c++) sums[3 * index[t + k] + c] += n[c];
        }
        const values = [];
        for (let t = 0; t < index.length; t++) {
            const v = index[t], face = unit(flat[Math.floor(t / 3)]), smooth = unit([sums[3 * v], sums[3 * v + 1], sums[3 * v + 2]]);
            values.push(...at(v), ...(dot(face, smooth) > 0.75 ? smooth : face));
        }
        this.solids.set(this.solidKey(i), { ...this.mesh(values, Uint32Array.from({ length: index.length }, (_, k) => k)), points: p, triangles: index });
    }

    /** The wall behind the scene, `size` m from its middle to its sides. */
    drawWall(shared, size) {
        const { room } = this, turn = room.wall_turn, along = [Math.cos(turn), Math.sin(turn), 0], away = [-along[1], along[0], 0];
        const middle = dot(room.target, along), half = [Math.sin(turn / 2) * Math.SQRT1_2, Math.cos(turn / 2) * Math.SQRT1_2];
        const place = [0, 1, 2].map((k) => room.wall_distance * away[k] + middle * along[k] + (k === 2 ? room.target[2] : 0));
        const modelMatrix = placed(place, [half[1], half[0], half[0], half[1]], [size, size, 1]); // upright, then turned
        this.use(this.programs.wall, {
            ...shared, modelMatrix, wallColour: room.wall_colour, wallAlong: along, bricks: [0, 1, -1][room.wall],
            floorHeight: room.ground_height ?? -1e4,
        });
        this.drawMesh(this.quad);
    }

    drawFire(camera, matrix, shared) {
        const { gl, frame, room } = this, { gas } = frame, { fire } = this.targets;
        if (!gas || !this.fire) {
            gl.bindFramebuffer(gl.FRAMEBUFFER, fire.frame);
            gl.clearColor(0, 0, 0, 1);
            gl.clear(gl.COLOR_BUFFER_BIT);
            return;
        }
        const span = gas.size.map((n) => n * gas.cell), lights = new Float32Array(24), ahead = unit(add(camera.target, camera.eye, -1));
        for (let k = 0; k < Math.min(6, frame.lightCount); k++) {
            const l = frame.lights.subarray(8 * k, 8 * k + 8);
            lights.set([l[0], l[1], l[2], l[4]], 4 * k);
        }
        // as fire_light_smoke has it
        const behind = 0.28 + 0.3 * Math.max(dot(room.towards, ahead), 0) ** 2;
        const daylight = room.sun.map((x, c) => behind * x + 0.282095 * room.ambient[c] + 0.630784 * room.ambient[18 + c]);
        this.pass("fire", fire, {
            ...shared, flameNoiseMap: this.flameNoise, fireMap: this.gas, depthMap: this.depth, inverse_: invert(matrix), low: gas.corner, high: add(gas.corner, span), origin: gas.corner, span,
            match_: [0, 0, 0], matchOn: 0, fireScale: flameScale(gas.cell), fireLights: lights, fireDaylight: daylight,
        });
    }

    /** Where a point is on the canvas, in its own pixels, or null behind the camera. */
    project(camera, p) {
        const m = this.matrices(camera), w = m[3] * p[0] + m[7] * p[1] + m[11] * p[2] + m[15];
        if (w <= 0) return null;
        const q = apply(m, p);
        return [(q[0] * 0.5 + 0.5) * this.canvas.clientWidth, (0.5 - q[1] * 0.5) * this.canvas.clientHeight];
    }

    ray(camera, x, y) {
        const back = invert(this.matrices(camera)), at = [(2 * x) / this.canvas.clientWidth - 1, 1 - (2 * y) / this.canvas.clientHeight];
        return { origin: camera.eye, direction: unit(add(apply(back, [at[0], at[1], 0.5]), camera.eye, -1)) };
    }
}
