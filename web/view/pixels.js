// How many pixels are drawn, as a share of all along each side: as many as the card draws in time while things move, and all
// of what stands still. The page and `singe view` wait by it until the card is done, so that no drawings queue up.

const SHARES = [0.35, 0.5, 0.7, 0.85, 1];
const IN_TIME = [Infinity, 32, 15, 15, 15]; // ms: 60 frames a second, or where pixels would be seen, 30
const LATE = { most: 2, within: 2000 }; // late drawings in so many ms: one of 60
const MORE = { first: 6, calm: 600 }; // drawings in a row with time to spare, before and after a share was too much
const FAILED = 60_000; // ms for which a share that was too much is not tried again
const SETTLES = 3; // drawings after a change, in which the card also makes its pictures anew
const STILL = 250; // ms

export class Pixels {
    #gl;
    #level = 0; // the first drawings also compile programs
    #fence = null;
    #fast = 0; // drawings in a row with time for more pixels
    #late = []; // when the last late ones were
    #settling = 0;
    #failed = SHARES.map(() => -Infinity); // when each share was too much
    #moved = 0;
    #whole = false;
    /** A share that tests ask for. @type {number | null} */
    fixed = null;
    /** Whether the share is not to change. */
    held = false;

    /** @param {WebGL2RenderingContext} gl */
    constructor(gl) { this.#gl = gl; }

    get share() { return this.fixed ?? (this.#whole ? 1 : SHARES[this.#level]); }
    /** Whether the card has drawn all that it was asked for. */
    get free() { return !this.#fence; }

    /** To be called before a drawing. @param {boolean} whole all pixels, as nothing moves */
    begin(now, whole = false) {
        this.#whole = whole;
        if (!whole) this.#moved = now;
    }

    /** Whether what was drawn with fewer pixels has stood still for a while. */
    rests(now) { return this.fixed === null && !this.held && this.free && this.share < 1 && now - this.#moved > STILL; }

    /** To be called after a drawing: measures how long the card takes. @param {(() => void) | null} then called when it is seen */
    end(then = null) {
        const gl = this.#gl, begun = performance.now(), fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
        if (!fence) return; // the context is lost
        this.#fence = fence;
        gl.flush();
        const look = () => {
            if (!gl.isContextLost() && gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED) return setTimeout(look, 1);
            gl.deleteSync(fence);
            if (this.#fence === fence) this.#fence = null;
            then?.();
            if (!this.#whole && !document.hidden) this.took(performance.now() - begun);
        };
        setTimeout(look, 1);
    }

    /** A drawing took so many ms. */
    took(ms, now = performance.now()) {
        if (this.fixed !== null || this.held) return;
        if (this.#settling > 0) return void this.#settling--;
        const level = this.#level, next = level + 1, more = (1 + (SHARES[next] / SHARES[level]) ** 2) / 2; // half of the time is for pixels
        this.#fast = more * ms < IN_TIME[next] && now - this.#failed[next] > FAILED ? this.#fast + 1 : 0;
        this.#late = this.#late.filter((time) => now - time < LATE.within);
        if (ms > IN_TIME[level]) this.#late.push(now);
        if (this.#late.length > LATE.most) {
            this.#failed[level] = now;
            this.#change(-1);
        } else if (this.#fast >= (this.#failed.every((time) => time === -Infinity) ? MORE.first : MORE.calm)) {
            this.#change(1);
        }
    }

    #change(by) {
        this.#level += by;
        this.#settling = SETTLES;
        this.#fast = 0;
        this.#late = [];
    }
}
