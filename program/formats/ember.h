// How much of a burning surface glows. Pictures, the light that embers throw, sparks, the live views and caches agree on it.
//
// Char glows where it burns without fuel. Where it still has some, the flame takes the air: then it glows in threads only, the
// less the slower it burns. And it glows in a line where it turns to ash.
#pragma once

#include "common/curves.h"
#include "singe/sim.h"

#define EMBER_BURN 0.74f   ///< the burn value in the middle of the glowing line
#define CHAR_LEAF 0.64f    ///< that of a leaf of char until it glows away: below the line's
#define STARVED 0.7f       ///< how much of char below a flame glows
#define STARVED_SLOW 0.08f ///< 1/s: what gives off its vapour as slowly is dark
#define STARVED_FAST 0.4f  ///< 1/s: what does so as fast glows as much as it can

#define STARVED_BEGINS 0.32f ///< burn values between which paper chars
#define STARVED_FULL 0.46f

/// The part that glows of char which burns at a rate (1/s), 0 to 1.
static inline float ember_activity(float rate) { return rate > 0 ? rate / (rate + 0.12f) : 0; }

/// The same of char that feeds a flame at a rate; `alone`: the part that glows without.
static inline float ember_starved(float rate, float burn, float alone) {
    return STARVED * stepf(STARVED_SLOW, STARVED_FAST, rate) * stepf(STARVED_BEGINS, STARVED_FULL, burn) * (1 - alone);
}

/// The part that glows of a leaf of char of which some burns alone and some feeds a flame, 1/s.
static inline float ember_leaf(float glowing, float starved, float burn) {
    const float alone = ember_activity(glowing);
    return alone + ember_starved(starved, burn, alone);
}

/// A vertex of a surface that burns.
typedef struct Ember {
    float burn;    ///< how far burnt it looks, 0 to 1: a leaf of char less than the sheet that is gone
    float flaming; ///< 1/s, the part of its rate that feeds a flame: 0 where char glows
    float starved; ///< 1/s, that part where there is char
} Ember;

/// `burn` and `rate` are the surface's, within their bounds. Without the arrays of mass nothing is known of char.
static inline Ember ember_at(const SingeSurface *s, uint32_t v, float burn, float rate) {
    if (!s->mass || !s->char_fraction || !s->ash_fraction) return (Ember){burn, rate, 0};
    const float charred = s->char_fraction[v] > 0 ? minf(s->char_fraction[v], 1) : 0; // 0 for NaN
    const float ash = s->ash_fraction[v] > 0 ? minf(s->ash_fraction[v], 1) : 0;
    const float left = s->mass[v] - s->char_fraction[v] - s->ash_fraction[v], fuel = left > 0 ? minf(left, 1) : 0;
    if (charred > 0) burn = mixf(burn, CHAR_LEAF * (1 - fuel), charred / (charred + 2 * ash));
    const float flaming = left > 0.01f ? rate : 0;
    return (Ember){burn, flaming, charred > 0 ? flaming : 0};
}

/// The part that glows of a vertex, 0 to 1.
static inline float ember_share(const SingeSurface *s, uint32_t v) {
    const float rate = s->burn_rate[v] > 0 ? s->burn_rate[v] : 0;
    const Ember ember = ember_at(s, v, clampf(s->burn[v], 0, 1), rate);
    const float line = stepf(CHAR_LEAF, EMBER_BURN, ember.burn) * ember_activity(rate);
    return maxf(line, ember_leaf(rate - ember.flaming, ember.starved, ember.burn));
}
