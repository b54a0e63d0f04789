// Draws the sparks and flakes of airborne.js into the stage's scene.
import { AIRBORNE_FLOATS, airborneOf, GLOWING, STARVED } from "./airborne.js";

const PARTS = ["from", "to", "across", "what"];

/** Of temperature, rate, glowing, burn, gradient and starved: which short of a vertex it is, and its value at 1 (SHEET_VERTEX in daylight.js). */
const SHORT = [18, 20, 20, 22, 23, 20], MOST = [5000, 64, 64, 1, 400, 64].map((most) => most / 65535);
const KINDS = { [GLOWING]: 65535, [STARVED]: 32768 }; // of what burns (PackVertex)

/** Of a frame, what airborneOf asks for. */
const valueOf = ({ reals, shorts }) => (vertex, field) =>
    field < 6 ? reals[16 * vertex + (field < 3 ? field : field + 1)]
        : field in KINDS && shorts[32 * vertex + 27] !== KINDS[field] ? 0 : shorts[32 * vertex + SHORT[field - 6]] * MOST[field - 6];

export class Flying {
    /** @param stage its WebGL, and @param program of AIRBORNE_VERTEX */
    constructor({ gl }, { program }) {
        this.array = gl.createVertexArray();
        this.things = gl.createBuffer();
        this.frame = null;
        this.count = 0;
        gl.bindVertexArray(this.array);
        gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
        gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0]), gl.STATIC_DRAW);
        const corner = gl.getAttribLocation(program, "position");
        gl.enableVertexAttribArray(corner);
        gl.vertexAttribPointer(corner, 3, gl.FLOAT, false, 0, 0);
        gl.bindBuffer(gl.ARRAY_BUFFER, this.things);
        PARTS.forEach((name, i) => {
            const place = gl.getAttribLocation(program, name);
            gl.enableVertexAttribArray(place);
            gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 4 * AIRBORNE_FLOATS, 12 * i);
            gl.vertexAttribDivisor(place, 1);
        });
        gl.bindVertexArray(null);
    }

    /** Draws what flies in the stage's frame, where the depth buffer lets it be seen. */
    draw(stage, shared) {
        const { gl, frame, room, canvas } = stage;
        if (this.frame !== frame) {
            const things = airborneOf(frame.triangles, valueOf(frame), frame.time, room);
            this.frame = frame;
            this.count = things.length / AIRBORNE_FLOATS;
            gl.bindBuffer(gl.ARRAY_BUFFER, this.things);
            gl.bufferData(gl.ARRAY_BUFFER, things, gl.STREAM_DRAW);
        }
        if (!this.count) return;
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
        gl.depthMask(false);
        stage.use(stage.programs.flying, { ...shared, resolution: [canvas.width, canvas.height] });
        gl.bindVertexArray(this.array);
        gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.count);
        gl.bindVertexArray(null);
        gl.depthMask(true);
        gl.disable(gl.BLEND);
    }
}
