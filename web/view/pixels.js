// How many pixels are drawn, as a share of all along each side: as many as leave 60 frames a second while things move, and all
// of what stands still. The page and `singe view` wait by it until the card is done, so that no drawings queue up.

const SHARES = [0.35, 0.5, 0.7, 0.85, 1];
const FRAME = 1000 / 60; // ms
const ENOUGH = 0.99; // of 60 frames a second
const BEHIND = 3 * FRAME; // ms behind that rate: the share is too much
const ROOM = 0.8 * FRAME; // ms of the card's own time within which a share is taken at once
const IDLE = 0.4 * FRAME; // ms below which it is not the card that is late
const CALM = { sure: 8, first: 30, tried: 240 }; // drawings without delay before more: with room, by trial, after a failure
const AGAIN = { sure: 15_000, trial: 60_000, times: 16 }; // ms after a failure, then twice as long each time until so many times
const SETTLES = 2; // drawings after a change, in which the card also makes its pictures anew

const STILL = 250; // ms

export class Pixels {
    #gl;
    #level = 0; // the first drawings also compile programs
    #fence = null;
    #query = null; // of the card's time for a drawing
    #measuring = false;
    #then = [];
    #tick = NaN; // the screen's frame that is being made
    #begun = null; // the one in which was drawn what the card is at
    #behind = 0; // ms
    #calm = 0; // drawings
    #most = undefined; // ms of the card's own time, the longest of late; where it does not tell, none
    #waited = false; // whether a frame came and the card was not done
    #settling = SETTLES;
    #failed = SHARES.map(() => ({ at: -Infinity, times: 1 }));
    #moved = 0;
    #whole = false;
    /** A share that tests ask for. @type {number | null} */
    fixed = null;
    /** Whether the share is not to change. */
    held = false;

    /** @param {WebGL2RenderingContext} gl */
    constructor(gl) { this.#gl = gl; }

    get share() { return this.fixed ?? (this.#whole ? 1 : SHARES[this.#level]); }
    /** Whether the card has drawn all that it was asked for, by the last tick. */
    get free() { return !this.#fence; }

    /**
     * To be called in each of the screen's frames: looks how far the card is. How long a drawing took is counted in such
     * frames, as timers of browsers come late. @param {number} now of requestAnimationFrame
     */
    tick(now) {
        this.#tick = now;
        if (!this.#fence) return;
        const gl = this.#gl;
        if (!gl.isContextLost() && gl.getSyncParameter(this.#fence, gl.SYNC_STATUS) === gl.UNSIGNALED) return void (this.#waited = true);
        gl.deleteSync(this.#fence);
        this.#fence = null;
        this.#then.splice(0).forEach((then) => then());
        this.#readTime();
        if (this.#begun !== null && this.fixed === null && !this.held) this.#took(now - this.#begun, now);
    }

    /** To be called before a drawing. @param {number} now @param {boolean} whole all pixels, as nothing moves */
    begin(now, whole = false) {
        const gl = this.#gl, timer = gl.getExtension("EXT_disjoint_timer_query_webgl2");
        this.#begun = whole || now !== this.#tick ? null : now; // what is drawn between two frames tells nothing of time
        this.#whole = whole;
        if (!whole) this.#moved = now;
        this.#measuring = timer !== null && !this.#query && this.#begun !== null;
        if (!this.#measuring) return;
        this.#query = gl.createQuery();
        gl.beginQuery(timer.TIME_ELAPSED_EXT, this.#query);
    }

    /** Whether what was drawn with fewer pixels has stood still for a while. */
    rests(now) { return this.fixed === null && !this.held && this.free && this.share < 1 && now - this.#moved > STILL; }

    /** To be called after a drawing. @param {(() => void) | null} then called when the card has done it */
    end(then = null) {
        const gl = this.#gl, timer = gl.getExtension("EXT_disjoint_timer_query_webgl2");
        if (this.#measuring && timer) gl.endQuery(timer.TIME_ELAPSED_EXT);
        if (this.#fence) gl.deleteSync(this.#fence);
        this.#fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0); // null where the context is lost
        if (then) this.#then.push(then);
        gl.flush();
    }

    #readTime() {
        const gl = this.#gl, timer = gl.getExtension("EXT_disjoint_timer_query_webgl2");
        if (!this.#query || (timer && !gl.isContextLost() && gl.getQueryParameter(this.#query, gl.QUERY_RESULT_AVAILABLE) === false)) return;
        if (timer && !gl.getParameter(timer.GPU_DISJOINT_EXT)) {
            const ms = gl.getQueryParameter(this.#query, gl.QUERY_RESULT) / 1e6, before = this.#most ?? ms;
            if (this.#settling === 0) this.#most = Math.max(ms, before + 0.05 * (ms - before));
        }
        gl.deleteQuery(this.#query);
        this.#query = null;
    }

    /** A drawing was done after so many ms, in the screen's frames. */
    #took(ms, now) {
        if (this.#settling > 0) {
            this.#settling--;
            this.#waited = false;
            return;
        }
        this.#behind = Math.min(Math.max(this.#behind + Math.min(ms, BEHIND) - FRAME / ENOUGH, 0), BEHIND);
        this.#calm++;
        if (this.#level > 0 && this.#behind === BEHIND && this.#isCard()) this.#fall(now);
        else if (this.#level + 1 < SHARES.length) this.#rise(now);
    }

    /** Whether it may be the card that is late; below half of the pixels, which is seen, whether it surely is. */
    #isCard() { return this.#most === undefined ? this.#level > 1 || this.#waited : this.#most > IDLE; }

    #fall(now) {
        const failed = this.#failed[this.#level];
        failed.times = Math.min(failed.at > -Infinity ? 2 * failed.times : 1, AGAIN.times);
        failed.at = now;
        this.#change(-1);
    }

    #rise(now) {
        const next = this.#level + 1, most = this.#most * (SHARES[next] / SHARES[this.#level]) ** 2, { at, times } = this.#failed[next]; // most: NaN where unknown
        const sure = most < ROOM, alone = most < IDLE || (this.#level === 0 && !this.#isCard()); // what is late is not the card
        if (now - at < times * (sure ? AGAIN.sure : AGAIN.trial) || (this.#behind > 0 && !alone)) return;
        const calm = sure ? CALM.sure : this.#failed.some((one) => one.at > -Infinity) ? CALM.tried : CALM.first;
        if (this.#calm >= calm) this.#change(1);
    }

    #change(by) {
        this.#level += by;
        this.#settling = SETTLES;
        this.#behind = this.#calm = 0;
        this.#most = undefined;
        this.#waited = false;
    }
}
