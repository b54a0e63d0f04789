// What a drawing needs of WebGL 2: programs and their values, pictures, meshes, and targets that are drawn into.
import { FIELDS } from "./frame.js";

export const GAP = FIELDS.length; // the attribute of contact

export class Card {
    /** @param {HTMLCanvasElement} canvas */
    constructor(canvas) {
        const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, preserveDrawingBuffer: true, powerPreference: "high-performance" });
        if (!gl || !gl.getExtension("EXT_color_buffer_float")) throw new Error("This view needs WebGL 2 with floating-point pictures, which this browser or its card does not have.");
        gl.getExtension("OES_texture_float_linear");
        this.gl = gl;
        this.canvas = canvas;
        this.targets = {};
    }

    program(vertex, fragment) {
        const { gl } = this, program = gl.createProgram();
        for (const [kind, text] of [[gl.VERTEX_SHADER, `precision highp float;\n${vertex}`], [gl.FRAGMENT_SHADER, fragment]]) {
            const shader = gl.createShader(kind);
            gl.shaderSource(shader, `#version 300 es\n${text}`);
            gl.compileShader(shader);
            gl.attachShader(program, shader);
            if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) throw new Error(gl.getShaderInfoLog(shader));
        }
        FIELDS.forEach(([name], i) => gl.bindAttribLocation(program, i, name));
        gl.bindAttribLocation(program, GAP, "gap");
        gl.linkProgram(program);
        if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) throw new Error(gl.getProgramInfoLog(program));
        const uniforms = new Map();
        for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i++) {
            const { name, type } = gl.getActiveUniform(program, i);
            uniforms.set(name.replace("[0]", ""), [gl.getUniformLocation(program, name), type]);
        }
        return { program, uniforms };
    }

    use({ program, uniforms }, values) {
        const { gl } = this;
        let unit_ = 0;
        gl.useProgram(program);
        for (const [name, [place, type]] of uniforms) {
            const value = values[name];
            if (value === undefined) throw new Error(`no value of ${name}`);
            switch (type) {
            case gl.FLOAT: gl.uniform1f(place, value); break;
            case gl.INT: gl.uniform1i(place, value); break;
            case gl.FLOAT_VEC2: gl.uniform2fv(place, value); break;
            case gl.FLOAT_VEC3: gl.uniform3fv(place, value); break;
            case gl.FLOAT_VEC4: gl.uniform4fv(place, value); break;
            case gl.FLOAT_MAT4: gl.uniformMatrix4fv(place, false, value); break;
            default:
                gl.activeTexture(gl.TEXTURE0 + unit_);
                gl.bindTexture(type === gl.SAMPLER_3D ? gl.TEXTURE_3D : type === gl.SAMPLER_2D_ARRAY ? gl.TEXTURE_2D_ARRAY : gl.TEXTURE_2D, value);
                gl.uniform1i(place, unit_++);
            }
        }
    }

    texture2d(width, height, inner, format, type, data, mip = false) {
        const { gl } = this, texture = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, texture);
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
        gl.texImage2D(gl.TEXTURE_2D, 0, inner, width, height, 0, format, type, data);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, mip ? gl.LINEAR_MIPMAP_LINEAR : gl.LINEAR);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
        for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, mip ? gl.REPEAT : gl.CLAMP_TO_EDGE);
        if (mip) {
            gl.generateMipmap(gl.TEXTURE_2D);
            const sharp = gl.getExtension("EXT_texture_filter_anisotropic");
            if (sharp) gl.texParameterf(gl.TEXTURE_2D, sharp.TEXTURE_MAX_ANISOTROPY_EXT, 8);
        }
        return texture;
    }

    texture3d(x, y, z, bytes, wrap, kind = this.gl.TEXTURE_3D) {
        const { gl } = this, texture = gl.createTexture();
        gl.bindTexture(kind, texture);
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
        gl.texImage3D(kind, 0, gl.RGBA, x, y, z, 0, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
        for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(kind, name, gl.LINEAR);
        for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R]) gl.texParameteri(kind, name, wrap);
        return texture;
    }

    /** Positions and normals by turns. */
    mesh(values, triangles) {
        const { gl } = this, array = gl.createVertexArray();
        gl.bindVertexArray(array);
        gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
        gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(values), gl.STATIC_DRAW);
        for (const i of [0, 1]) {
            gl.enableVertexAttribArray(i);
            gl.vertexAttribPointer(i, 3, gl.FLOAT, false, 24, 12 * i);
        }
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
        gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(triangles), gl.STATIC_DRAW);
        gl.bindVertexArray(null);
        return { array, count: triangles.length };
    }

    target(name, width, height) {
        const { gl } = this, old = this.targets[name];
        if (old) { gl.deleteTexture(old.texture); gl.deleteFramebuffer(old.frame); }
        const texture = this.texture2d(width, height, gl.RGBA16F, gl.RGBA, gl.HALF_FLOAT, null), frame = gl.createFramebuffer();
        gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
        this.targets[name] = { texture, frame, width, height };
    }

    drawMesh({ array, count }) {
        this.gl.bindVertexArray(array);
        this.gl.drawElements(this.gl.TRIANGLES, count, this.gl.UNSIGNED_INT, 0);
    }

    pass(program, to, values) {
        const { gl } = this;
        gl.bindFramebuffer(gl.FRAMEBUFFER, to ? to.frame : null);
        gl.viewport(0, 0, to ? to.width : this.canvas.width, to ? to.height : this.canvas.height);
        this.use(this.programs[program], values);
        this.drawMesh(this.quad);
    }
}
