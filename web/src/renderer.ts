// Draws a frame of the worker: the table, the sheet, the match and pins, then the fire, a lens's halo and a film's curve.
import {
    AddEquation, BufferGeometry, CanvasTexture, CustomBlending, CylinderGeometry, Data3DTexture, DataArrayTexture, DataTexture, DepthTexture, DoubleSide, DynamicDrawUsage, GLSL3, HalfFloatType,
    InstancedBufferGeometry, InstancedInterleavedBuffer, InterleavedBuffer, InterleavedBufferAttribute, BufferAttribute, LatheGeometry, LessEqualCompare, LinearFilter, LinearSRGBColorSpace, Matrix4, Mesh,
    NoColorSpace, OneFactor, OneMinusSrcAlphaFactor, OrthographicCamera, PerspectiveCamera, PlaneGeometry, RawShaderMaterial, RepeatWrapping, RGBAFormat, Scene,
    SphereGeometry, SRGBColorSpace, Texture, UnsignedByteType, UnsignedIntType, Vector2, Vector3, Vector4, WebGLRenderer, WebGLRenderTarget,
    DataUtils, type IUniform,
} from "three";
import { ATTRIBUTES, FLOATS } from "./fields.js";
import type { Frame } from "./messages.js";
import { BALL, placeOf, type Place, type Point, type Sides, type Where } from "./places.js";
import { AIRBORNE_FLOATS, AIRBORNE_LIMIT } from "../view/airborne.js";
import { flameNoiseBytes, glowBytes, noiseBytes, sliceBytes } from "../view/tables.js";
import * as glsl from "../view/shaders.js";

/** Behind what lies, before what hangs. */
const LAMPS = { lying: new Vector3(-0.19, 0.21, 0.34), hanging: new Vector3(-0.26, -0.34, 0.42) };
const LAMP = { at: LAMPS.lying.clone(), to: new Vector3(0.0, 0.01, 0), ahead: new Vector3(), colour: [0.092, 0.064, 0.037] };
const NIGHT = new Vector3(0.0150, 0.0172, 0.0262);
const EXPOSURE = 1.0;
const SHADOW = 1024;
const FIRE_LIGHT = 3.6e-5; // strength of a cell that burns fully
const FULL_PAPER = 0.19; // light that comes through (preview.h)

const EMBER_LIGHT = 0.0012;

export const CONTEXT: WebGLContextAttributes = { antialias: false, powerPreference: "high-performance", preserveDrawingBuffer: true };

type Uniforms = Record<string, IUniform>;

export class Renderer {
    readonly camera = new PerspectiveCamera(30, 1, 0.02, 6);
    readonly paper: Mesh<BufferGeometry, RawShaderMaterial>;
    private gl: WebGLRenderer;
    private scene = new Scene();
    private shadowScene = new Scene();
    private lampView = new Matrix4();
    private moved = true; // what casts shadows, or the lamp
    private ball: Mesh;
    private ember: Mesh<SphereGeometry, RawShaderMaterial>;
    private where: Where = placeOf("table");
    private lamp = new PerspectiveCamera(70, 1, 0.08, 1.2);
    private shared: Uniforms;
    private sceneTarget: WebGLRenderTarget;
    private fireTarget = target();
    private bright = target();
    private across = target();
    private halo = target();
    private glare = target();
    private shadowTarget = new WebGLRenderTarget(SHADOW, SHADOW);
    private full = new Mesh(new PlaneGeometry(2, 2));
    private fullCamera = new OrthographicCamera(-1, 1, 1, -1, 0, 1);
    private passes: Record<"fire" | "bright" | "blur" | "film", RawShaderMaterial>;
    private blank = white();
    private buffer: InterleavedBuffer | null = null;
    private fireMap: Data3DTexture | null = null;
    private match: Mesh[];
    private pins: Mesh[] = [];
    private airborne: Mesh<InstancedBufferGeometry, RawShaderMaterial>;
    private airborneBuffer = new InstancedInterleavedBuffer(new Float32Array(AIRBORNE_LIMIT * AIRBORNE_FLOATS), AIRBORNE_FLOATS);
    private solid: (albedo: Point, gloss: number) => RawShaderMaterial;

    /** @param canvas whose context has CONTEXT */
    constructor(canvas: HTMLCanvasElement) {
        this.gl = new WebGLRenderer({ canvas, context: canvas.getContext("webgl2")!, ...CONTEXT });
        this.gl.autoClear = false;
        this.gl.outputColorSpace = LinearSRGBColorSpace;
        this.camera.up.set(0, 0, 1);

        const depth = new DepthTexture(SHADOW, SHADOW, UnsignedIntType);
        depth.compareFunction = LessEqualCompare;
        depth.minFilter = depth.magFilter = LinearFilter;
        this.shadowTarget.depthTexture = depth;
        this.lamp.up.set(0, 0, 1);

        this.sceneTarget = new WebGLRenderTarget(4, 4, { type: HalfFloatType, samples: 4, depthTexture: new DepthTexture(4, 4, UnsignedIntType) });
        this.shared = {
            noiseMap: { value: noiseTexture(Data3DTexture, noiseBytes()) }, sliceMap: { value: noiseTexture(DataArrayTexture, sliceBytes()) }, glowMap: { value: glowTexture() }, viewProjection: { value: new Matrix4() },
            eye: { value: new Vector3() }, lampAt: { value: LAMP.at }, lampAhead: { value: LAMP.ahead }, lampColour: { value: new Vector3(...LAMP.colour as Point) },
            nightColour: { value: NIGHT }, lampView: { value: this.lampView }, shadowMap: { value: depth }, time: { value: 0 },
            fireLights: { value: Array.from({ length: 6 }, () => new Vector4()) }, fireColour: { value: new Vector3(1, 0.46, 0.13) },
        };

        const paperUniforms = { ...this.shared, printMap: { value: white() }, backMap: { value: this.blank }, dyed: { value: 0 }, transmittance: { value: FULL_PAPER }, tint: { value: new Vector3(1, 1, 1) } };
        const paper = material(glsl.PAPER_VERTEX, glsl.paper(glsl.LAMP), paperUniforms);
        paper.side = DoubleSide;
        this.paper = new Mesh(new BufferGeometry(), paper);
        this.paper.frustumCulled = false;
        const caster = material(glsl.PAPER_VERTEX, glsl.paper(glsl.LAMP), { ...paperUniforms, viewProjection: { value: this.lampView }, shadowMap: { value: null } });
        caster.defines = { SHADOW: 1 };
        caster.side = DoubleSide;
        const cast = new Mesh(this.paper.geometry, caster);
        cast.frustumCulled = false;
        this.shadowScene.add(cast);

        const table = new Mesh(new PlaneGeometry(5, 5), material(glsl.PLAIN_VERTEX, glsl.table(glsl.LAMP, "vec3(0.20, 0.105, 0.052)", "float far = length(p.xy) / 1.5; c *= exp(-far * far);"), this.shared));
        this.solid = (albedo, gloss) => material(glsl.PLAIN_VERTEX, glsl.solid(glsl.LAMP), {
            ...this.shared, albedo: { value: new Vector3(...albedo) }, kelvin: { value: 0 }, gloss: { value: gloss },
        });
        const stick = new Mesh(new CylinderGeometry(0.0011, 0.0011, 0.05, 8).translate(0, -0.027, 0), this.solid([0.55, 0.37, 0.2], 0.02));
        const head = new Mesh(new SphereGeometry(0.002, 12, 8).scale(1, 1.5, 1), this.solid([0.035, 0.02, 0.018], 0.03));
        this.match = [stick, head];
        for (const part of this.match) {
            part.visible = false;
            part.rotation.set(-0.45, 0.0, -0.75); // held from the right, upwards
        }
        this.ball = new Mesh(new SphereGeometry(BALL.radius, 64, 40).translate(...BALL.at), this.solid([0.16, 0.15, 0.14], 0.12));
        this.ember = new Mesh(new SphereGeometry(1, 48, 32), this.solid([0.02, 0.02, 0.02], 0.02));
        this.airborne = new Mesh(flying(this.airborneBuffer), material(glsl.AIRBORNE_VERTEX, glsl.airborne(glsl.LAMP), { ...this.shared, resolution: { value: new Vector2(1, 1) } }));
        Object.assign(this.airborne.material, { side: DoubleSide, transparent: true, depthWrite: false, blending: CustomBlending, blendEquation: AddEquation, blendSrc: OneFactor, blendDst: OneMinusSrcAlphaFactor });
        this.airborne.frustumCulled = false;
        this.scene.add(this.airborne, table, this.paper, this.ball, this.ember, ...this.match);
        this.setPlace("table");

        const seen = { sceneMap: { value: this.sceneTarget.texture }, fireMap2: { value: this.fireTarget.texture } };
        this.passes = {
            fire: material(glsl.FULL_VERTEX, glsl.FIRE, {
                ...this.shared, flameNoiseMap: { value: noiseTexture(Data3DTexture, flameNoiseBytes()) }, fireMap: { value: null }, depthMap: { value: this.sceneTarget.depthTexture }, inverse_: { value: new Matrix4() },
                low: { value: new Vector3() }, high: { value: new Vector3() }, origin: { value: new Vector3() }, span: { value: new Vector3(1, 1, 1) },
                match_: { value: new Vector3() }, matchOn: { value: 0 }, fireScale: { value: 1 }, fireDaylight: { value: new Vector3(...LAMP.colour as Point).multiplyScalar(0.1) },
            }),
            bright: material(glsl.FULL_VERTEX, glsl.BRIGHT, { ...seen, pixel: { value: new Vector2() }, exposure: { value: EXPOSURE } }),
            blur: material(glsl.FULL_VERTEX, glsl.BLUR, { map: { value: null }, along: { value: new Vector2() }, sigma: { value: 1 } }),
            film: material(glsl.FULL_VERTEX, glsl.FILM, {
                ...seen, halo: { value: this.halo.texture }, glare: { value: this.glare.texture }, exposure: { value: EXPOSURE }, vignette: { value: 0.32 },
                resolution: { value: new Vector2(1, 1) },
            }),
        };
        this.full.frustumCulled = false;

        // all programs are asked for before one is waited for
        for (const scene of [this.shadowScene, this.scene]) this.gl.compile(scene, this.camera);
        for (const one of Object.values(this.passes)) {
            this.full.material = one;
            this.gl.compile(this.full, this.fullCamera);
        }
    }

    /** The card's name, to be told in a message. */
    get card(): string {
        const gl = this.gl.getContext(), info = gl.getExtension("WEBGL_debug_renderer_info");
        return info ? String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "unknown";
    }

    resize(width: number, height: number, scale: number): void {
        const w = Math.max(2, Math.round(width * scale)), h = Math.max(2, Math.round(height * scale));
        this.gl.setSize(w, h, false);
        this.sceneTarget.setSize(w, h);
        this.fireTarget.setSize(Math.ceil(w / 2), Math.ceil(h / 2));
        for (const small of [this.bright, this.across, this.halo, this.glare]) small.setSize(Math.ceil(w / 4), Math.ceil(h / 4));
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
        for (const { uniforms } of [this.passes.film, this.airborne.material]) (uniforms.resolution!.value as Vector2).set(w, h);
    }

    /** What is printed on the sheet, and where it is seen. */
    print(picture: HTMLCanvasElement, sides: Sides): void {
        const uniforms = this.paper.material.uniforms, old = uniforms.printMap!.value as Texture, texture = new CanvasTexture(picture);
        texture.colorSpace = SRGBColorSpace;
        texture.anisotropy = 8;
        uniforms.printMap!.value = texture;
        old.dispose();
        this.setSides(sides);
    }

    setSides(sides: Sides): void {
        const uniforms = this.paper.material.uniforms;
        uniforms.backMap!.value = sides === "both" ? uniforms.printMap!.value : this.blank;
        uniforms.dyed!.value = sides === "through" ? 1 : 0;
    }

    /** The print has changed. */
    reprint(): void { (this.paper.material.uniforms.printMap!.value as Texture).needsUpdate = true; }

    // ---- a frame's data

    show(frame: Frame): void {
        this.moved = true;
        this.setMesh(frame);
        this.setFire(frame);
        (this.airborneBuffer.array as Float32Array).set(frame.airborne);
        this.airborneBuffer.needsUpdate = true;
        this.airborne.geometry.instanceCount = frame.airborne.length / AIRBORNE_FLOATS;
        this.shared.time!.value = frame.time % 1000;
        const lights = this.shared.fireLights!.value as Vector4[];
        lights.forEach((light, i) => {
            const [x, y, z, weight] = frame.lights.subarray(4 * i, 4 * i + 4) as unknown as [number, number, number, number];
            const flicker = 1 + 0.16 * Math.sin(41 * frame.time + 2.4 * i) + 0.12 * Math.sin(67 * frame.time + i * i);
            light.set(x, y, z, weight * FIRE_LIGHT * flicker);
        });
        this.moveEmber(frame.time);
        while (this.pins.length < frame.pins.length) {
            const pin = new Mesh(tack(), this.solid([0.55, 0.36, 0.10], 0.5));
            this.pins.push(pin);
            this.scene.add(pin);
        }
        this.pins.forEach((pin, i) => {
            pin.visible = i < frame.pins.length;
            if (pin.visible) pin.position.set(...frame.pins[i]!);
        });
    }

    /** Sets the lamp, and what else the scene has. */
    setPlace(place: Place): void {
        this.where = placeOf(place);
        this.moved = true;
        this.ball.visible = !!this.where.ball;
        this.moveEmber(0);
        LAMP.at.copy(this.where.upright ? LAMPS.hanging : LAMPS.lying);
        LAMP.to.setZ(this.where.upright ? 0.17 : 0);
        LAMP.ahead.subVectors(LAMP.to, LAMP.at).normalize();
        this.lamp.position.copy(LAMP.at);
        this.lamp.lookAt(LAMP.to);
        this.lamp.updateMatrixWorld();
        this.lampView.multiplyMatrices(this.lamp.projectionMatrix, this.lamp.matrixWorldInverse);
    }

    /** The glowing ball of a scene, which lights the sheet. */
    private moveEmber(time: number): void {
        const { ember } = this.where;
        this.ember.visible = !!ember;
        if (!ember) return;
        this.ember.material.uniforms.kelvin!.value = ember.temperature;
        const { path, radius } = ember, next = Math.max(1, path.findIndex((key) => key.time > time)), [from, to] = [path[next - 1]!, path[next]!];
        const share = Math.min((time - from.time) / (to.time - from.time), 1);
        this.ember.position.set(...from.position as Point).lerp(new Vector3(...to.position as Point), share);
        this.ember.scale.setScalar(radius);
        (this.shared.fireLights!.value as Vector4[])[4]!.set(...this.ember.position.toArray(), EMBER_LIGHT);
    }

    /** Where a match burns, or null. */
    setMatch(at: Point | null): void {
        for (const part of this.match) {
            part.visible = !!at;
            if (at) part.position.set(at[0], at[1], at[2] + 0.003);
        }
        const uniforms = this.passes.fire.uniforms;
        uniforms.matchOn!.value = at ? 1 : 0;
        if (!at) return;
        (uniforms.match_!.value as Vector3).set(at[0], at[1], at[2] + 0.004);
        (this.shared.fireLights!.value as Vector4[])[5]!.set(at[0], at[1], at[2] + 0.018, 0.0005 * (1 + 0.15 * Math.sin(performance.now() / 31)));
    }

    private setMesh({ vertices, triangles }: Frame): void {
        const { geometry } = this.paper, room = this.buffer ? this.buffer.array.length : 0;
        if (vertices.length > room) {
            geometry.dispose();
            this.buffer = new InterleavedBuffer(new Float32Array(Math.ceil(1.3 * vertices.length / FLOATS) * FLOATS), FLOATS);
            this.buffer.setUsage(DynamicDrawUsage);
            let offset = 0;
            for (const [name, size] of ATTRIBUTES) {
                geometry.setAttribute(name, new InterleavedBufferAttribute(this.buffer, size, offset));
                offset += size;
            }
        }
        const buffer = this.buffer!;
        (buffer.array as Float32Array).set(vertices);
        buffer.clearUpdateRanges();
        buffer.addUpdateRange(0, vertices.length);
        buffer.needsUpdate = true;
        let index = geometry.getIndex();
        if (!index || index.array.length < triangles.length) {
            index = new BufferAttribute(new Uint32Array(Math.ceil(1.3 * triangles.length)), 1);
            index.setUsage(DynamicDrawUsage);
            geometry.setIndex(index);
        }
        (index.array as Uint32Array).set(triangles);
        index.clearUpdateRanges();
        index.addUpdateRange(0, triangles.length);
        index.needsUpdate = true;
        geometry.setDrawRange(0, triangles.length);
    }

    private setFire({ fire }: Frame): void {
        const uniforms = this.passes.fire.uniforms, vector = (name: string) => uniforms[name]!.value as Vector3;
        vector("low").setScalar(1e6); // out of every view
        vector("high").setScalar(1e6);
        if (!fire?.bounds) return;
        const [x, y, z] = fire.size;
        if (!this.fireMap || this.fireMap.image.width !== x || this.fireMap.image.height !== y || this.fireMap.image.depth !== z) {
            this.fireMap?.dispose();
            this.fireMap = new Data3DTexture(fire.cells as Uint8Array<ArrayBuffer>, x, y, z);
            this.fireMap.format = RGBAFormat;
            this.fireMap.minFilter = this.fireMap.magFilter = LinearFilter;
        }
        this.fireMap.image.data = fire.cells;
        this.fireMap.needsUpdate = true;
        uniforms.fireMap!.value = this.fireMap;
        uniforms.fireScale!.value = fire.scale;
        vector("low").set(...fire.bounds.low);
        vector("high").set(...fire.bounds.high);
        vector("origin").set(...fire.origin);
        vector("span").set(x * fire.cell, y * fire.cell, z * fire.cell);
    }

    // ---- drawing

    draw(): void {
        const { gl, camera } = this;
        camera.updateMatrixWorld();
        (this.shared.viewProjection!.value as Matrix4).multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
        (this.shared.eye!.value as Vector3).copy(camera.position);
        (this.passes.fire.uniforms.inverse_!.value as Matrix4).copy(this.shared.viewProjection!.value as Matrix4).invert();

        if (this.moved) { // a turned view has the same shadows
            this.moved = false;
            gl.setRenderTarget(this.shadowTarget);
            gl.clear(true, true, false);
            gl.render(this.shadowScene, this.lamp);
        }
        gl.setRenderTarget(this.sceneTarget);
        gl.setClearColor(0x000000, 1);
        gl.clear(true, true, false);
        gl.render(this.scene, camera);

        this.pass(this.passes.fire, this.fireTarget);
        const { width, height } = this.sceneTarget, bright = this.passes.bright.uniforms;
        (bright.pixel!.value as Vector2).set(1 / width, 1 / height);
        this.pass(this.passes.bright, this.bright);
        this.blur(this.halo, 0.005 * height / 4);
        this.blur(this.glare, 0.022 * height / 4);
        this.pass(this.passes.film, null);
    }

    private blur(to: WebGLRenderTarget, sigma: number): void {
        const uniforms = this.passes.blur.uniforms, along = uniforms.along!.value as Vector2;
        uniforms.sigma!.value = Math.max(sigma, 0.5);
        uniforms.map!.value = this.bright.texture;
        along.set(1 / this.bright.width, 0);
        this.pass(this.passes.blur, this.across);
        uniforms.map!.value = this.across.texture;
        along.set(0, 1 / this.bright.height);
        this.pass(this.passes.blur, to);
    }

    private pass(with_: RawShaderMaterial, to: WebGLRenderTarget | null): void {
        this.full.material = with_;
        this.gl.setRenderTarget(to);
        this.gl.render(this.full, this.fullCamera);
    }
}

// ---- what does not change

function target(): WebGLRenderTarget {
    return new WebGLRenderTarget(4, 4, { type: HalfFloatType, depthBuffer: false, minFilter: LinearFilter, magFilter: LinearFilter });
}

function material(vertex: string, fragment: string, uniforms: Uniforms): RawShaderMaterial {
    return new RawShaderMaterial({ vertexShader: `precision highp float;\n${vertex}`, fragmentShader: fragment, uniforms, glslVersion: GLSL3 });
}

function white(): Texture {
    const texture = new DataTexture(new Uint8Array([255, 255, 255, 255]), 1, 1);
    texture.needsUpdate = true;
    return texture;
}

function noiseTexture(kind: typeof Data3DTexture | typeof DataArrayTexture, { side, bytes }: ReturnType<typeof noiseBytes>): Data3DTexture | DataArrayTexture {
    const texture = new kind(bytes, side, side, bytes.length / (4 * side * side));
    texture.format = RGBAFormat;
    texture.type = UnsignedByteType;
    texture.wrapS = texture.wrapT = RepeatWrapping;
    if (texture instanceof Data3DTexture) texture.wrapR = RepeatWrapping;
    texture.minFilter = texture.magFilter = LinearFilter;
    texture.unpackAlignment = 1;
    texture.colorSpace = NoColorSpace;
    texture.needsUpdate = true;
    return texture;
}

function glowTexture(): DataTexture {
    const { width, values } = glowBytes(), data = Uint16Array.from(values, (c) => DataUtils.toHalfFloat(c));
    const texture = new DataTexture(data, width, 2, RGBAFormat, HalfFloatType);
    texture.minFilter = LinearFilter;
    texture.magFilter = LinearFilter;
    texture.needsUpdate = true;
    return texture;
}

/** A corner each of the quads of sparks and flakes. */
function flying(buffer: InstancedInterleavedBuffer): InstancedBufferGeometry {
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    ["from", "to", "across", "what"].forEach((name, i) => geometry.setAttribute(name, new InterleavedBufferAttribute(buffer, 3, 3 * i)));
    geometry.instanceCount = 0;
    buffer.setUsage(DynamicDrawUsage);
    return geometry;
}

/** A brass tack, its point down. */
function tack(): LatheGeometry {
    const outline = [[0, 0.0048], [0.0016, 0.0045], [0.0032, 0.0034], [0.0037, 0.0022], [0.0036, 0.0018], [0.0012, 0.0016], [0.001, 0]] as const;
    return new LatheGeometry(outline.map(([r, h]) => new Vector2(r, h)), 20).rotateX(Math.PI / 2) as LatheGeometry;
}

