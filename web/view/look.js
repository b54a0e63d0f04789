// Made by scripts/write_look.py from program/preview: do not edit.
export const LOOK = { EMBER_BURN: 0.74, CHAR_LEAF: 0.64, STARVED: 0.7, STARVED_SLOW: 0.08, STARVED_FAST: 0.4, STARVED_BEGINS: 0.32, STARVED_FULL: 0.46, FIRE_SCALE_CELL: 0.01, FIRE_FINE_CELL: 0.008, FLAMES_FROM: 0.02, FLAME_SEEN: 0.15, FLAME_HEIGHT: 0.08, FLAME_END: 0.3, RISE_MOST: 0.55, EDDY_RATE: 8, FLAME_DIM: 0.26, FLAME_BRIGHT: 5.9, TAPER: 0.55, FLAME_MOST: 2, FIRE_SWAY: 0.027, LICK_WIDE: 0.045, LICK_FULL: 0.05, LICK: 0.6, UNLIKE: 1.5, JOIN: 0.7, JOIN_BEGINS: 0.02, JOIN_FULL: 0.08, GROUP_WIDE: 0.075, GROUP_RATE: 2, GROUP: 0.35, GROUP_UNLIKE: 1.5, FED_WHOLLY: 0.3, FLAME_COOL: 1200, FLAME_HOT: 2000, LEAF_WIDTH: 0.008, FLAME_LOW: 50000, FLAME_HIGH: 5e+06, FLAME_THICK: 0.014, ROOT_REACH: 4.4, ROOT_OVER: 1.5, ROOT_FALLS: 0.05, ROOT_WIDE: 0.6, ROOT_LEAN: 0.4, NOISE_LARGER: 0.85, NOISE_SIZES: 0.68, FIRE_PASSING: 0.93, MIX_PASSES: 2, MIX_SHARE: 0.2, MIX_BEGINS: 0.01, MIX_FULL: 0.06, MIX_FEEDS: 0.5, MIX_BURNT: 1.5, SMOKE_LEAVES: 0.25, LEAN: 0.17, LEAN_HIGH: 0.6, LEAN_BEGINS: 0.02, LEAN_ENDS: 0.06, LEAN_BELOW: 2, BELOW_FREE: 1.5, LEAN_FOOT: 0.3, LEAN_FALLS: 1.3, RIM_FLAME: 0.85, RIM_REACH: 1.5, RIM_UP: 0.6, RIM_BELOW: 2, RIM_LOW: 0.1, RIM_HIGH: 1, NOWHERE: 0.04, FAR: 0.039, SLAB: 0.55, SHAPE_GAIN: 0.265, SHAPE_MIDDLE: 80, SHAPE_LIMB: 330, SHAPE_BELOW: 150, SCALE_COOLER: 200, LAMP_WRAP: 0.3, LAMP_WRAP_MOST: 0.7 };

export const PAPER = /* glsl */ `
const float EMBER_BURN = 0.74;
const float STARVED = 0.7;
const float STARVED_SLOW = 0.08;
const float STARVED_FAST = 0.4;
const float STARVED_BEGINS = 0.32;
const float STARVED_FULL = 0.46;
const float PAPER_WHOLE = 0.35;
const float EMBER_WIDTH = 0.00042;
const float EMBER_GAIN = 3.4;
const float EMBER_MOST = 6.0;
const float FIBRE_WAVES = 0.007;
const float BAY = 0.0055;
const float EMBER_HOT = 1180.0;
const float LEAF_SPREAD = 1.35;
const float LEAF_STARVES = 0.2;
const float LEAF_FRONT = 1.1;
const float LEAF_DULL = 1.7;
const float LEAF_SCATTERS = 0.4;
const float LEAF_COOLER = 150.0;
const float LEAF_BRIGHT = 1.2;
const float LEAF_DIM = 150.0;
const float LEAF_CORE = 60.0;
const float STARVED_COOLER = 90.0;
const float STARVED_BORDER = 0.42;
const float INK_LEAST = 0.6;
const float SHEEN = 0.09;
const float BLACKBODY_MIN = 780.0;
struct PaperState { vec3 rest; float temperature; float peak; float burn; float burn_rate; float gradient; float heat_gradient; float rim; float spacing; float glowing; float starved; float age; float water; float edge; };
struct Bent { vec3 position; float burn; float temperature; float peak; float coarse; float medium; float fine; float bays; };
float ember_activity(float rate) { return rate > 0.0 ? rate / (rate + 0.12) : 0.0; }
float ember_starved(float rate, float burn, float alone) {
    return STARVED * stepf(STARVED_SLOW, STARVED_FAST, rate) * stepf(STARVED_BEGINS, STARVED_FULL, burn) * (1.0 - alone);
}
float ember_temperature(float mean) { return mean + 110.0; }
vec3 noise3_gradient(vec3 p, float n, float seed) {
    float e = 0.25;
    return vec3((noise3(vec3(p.x + e, p.y, p.z), seed) - n) / e, (noise3(vec3(p.x, p.y + e, p.z), seed) - n) / e,
                  (noise3(vec3(p.x, p.y, p.z + e), seed) - n) / e);
}
float paper_noise(vec3 position, float millimetres, float footprint, float seed) {
    float visible = 1.6 - footprint * 1000.0 / millimetres * 0.8;
    if (visible <= 0.0) return 0.0;
    return min(visible, 1.0) * noise3(float3_scale(position, 1000.0 / millimetres), seed);
}
float ridge(float n, float width) { return 1.0 - stepf(0.0, width, abs(n)); }
vec3 scorch_colour(float s) {
    float STOPS = 8.0;
    vec4 stop[8] = vec4[8](vec4(0.00, 1.00, 1.00, 1.00),    vec4(0.09, 0.975, 0.93, 0.81),
                                         vec4(0.21, 0.84, 0.68, 0.44),    vec4(0.57, 0.53, 0.34, 0.165),
                                         vec4(0.68, 0.32, 0.165, 0.068),  vec4(0.77, 0.14, 0.062, 0.026),
                                         vec4(0.86, 0.056, 0.030, 0.018), vec4(1.00, 0.020, 0.016, 0.014));
    float i = 1.0;
    while (i < STOPS - 1.0 && s > stop[int(i)][0]) i++;
    float f = clamp((s - stop[int(i - 1.0)][0]) / (stop[int(i)][0] - stop[int(i - 1.0)][0]), 0.0, 1.0);
    return mix(stop[int(i - 1.0)].yzw, stop[int(i)].yzw, f);
}
vec3 askew(vec3 r) {
    return vec3(0.7654 * r.x - 0.5321 * r.y + 0.3622 * r.z, 0.6133 * r.x + 0.7718 * r.y - 0.1673 * r.z,
                  -0.1905 * r.x + 0.3481 * r.y + 0.9179 * r.z);
}
Bent shade_paper_bend(PaperState state, float footprint) {
    Bent bent = Bent(askew(state.rest), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    bent.coarse = paper_noise(bent.position, 4.0, footprint, 1.0);
    bent.medium = paper_noise(bent.position, 1.3, footprint, 2.0);
    bent.fine = paper_noise(bent.position, 0.45, footprint, 3.0);
    if (state.burn > PAPER_WHOLE) bent.bays = paper_noise(bent.position, 9.5, footprint, 4.0);
    float delta = 1.5e-3 * bent.coarse + 0.7e-3 * bent.medium + 0.22e-3 * bent.fine;
    delta *= clamp(state.spacing / 1.8e-3, 0.3, 1.0);
    float slope = min(state.gradient, 400.0);
    float inside = stepf(0.15, 0.5, state.burn);
    bent.burn = state.burn + slope * delta + inside * (0.03 * bent.coarse + 0.05 * bent.medium + 0.03 * bent.fine);
    float jitter = (0.17 * bent.coarse + 0.08 * bent.medium + 0.025 * bent.fine) * (1.0 - 0.6 * inside);
    float peak = max(state.peak, state.temperature);
    bent.temperature = state.temperature + (state.temperature - 293.0) * jitter * stepf(320.0, 420.0, state.temperature);
    float steep = min(state.heat_gradient, 1.2e5);
    bent.peak = peak + (0.25 * (peak - 293.0) * jitter + steep * delta) * stepf(310.0, 350.0, peak);
    return bent;
}
float paper_cracks(Bent bent, float millimetres, float width, float footprint) {
    vec3 p = float3_mad(bent.position, vec3(bent.medium, bent.fine, bent.coarse), 0.5e-3);
    float min_ = 0.5 * footprint * 1000.0 / millimetres;
    float open = width * max(0.0, 0.75 + 0.9 * bent.coarse + 0.5 * bent.medium);
    float wall = noise_walls(float3_scale(p, 1000.0 / millimetres), 13.0);
    return min(1.0, open / min_) * (1.0 - stepf(0.4, 1.0, wall / max(open, min_)));
}
void tilt(vec3 position, float millimetres, float height, bool folded, float seed, inout Point point) {
    height *= clamp(1.6 - point.footprint * 1000.0 / millimetres, 0.0, 1.0);
    if (height < 0.02) return;
    vec3 p = float3_scale(position, 1000.0 / millimetres);
    float n = noise3(p, seed);
    vec3 slope = noise3_gradient(p, n, seed);
    if (folded) {
        float edge = clamp(n * 14.0, -1.0, 1.0), steep = length(slope);
        slope = float3_scale(slope, edge / (0.5 + 0.5 * steep));
    }
    slope = float3_mad(slope, point.normal, -dot(slope, point.normal));
    vec3 tilted = float3_unit_or(float3_mad(point.normal, slope, -height), point.normal);
    if (dot(tilted, point.view) > 0.02) point.normal = tilted;
}
float ash_amount(Bent bent) {
    return stepf(0.78, 0.94, bent.burn + 0.06 * bent.coarse) * (1.0 - 0.75 * stepf(760.0, 1000.0, bent.temperature));
}
float border_bite(float burn, Bent bent) {
    float bite = 0.40 + 0.38 * bent.medium + 0.20 * bent.fine + 0.28 * bent.coarse;
    return stepf(PAPER_WHOLE, 0.65, burn) * clamp(bite, 0.0, 0.85);
}
float border_bay(PaperState state, Bent bent) {
    float bay = bent.bays + 0.55 * bent.coarse + 0.3 * bent.medium + 0.15 * bent.fine - 0.1;
    return BAY * stepf(PAPER_WHOLE, 0.6, state.burn) * clamp(bay, 0.0, 1.0);
}
float border_distance(PaperState state, Bent bent) {
    float bite = border_bite(state.burn, bent) * min(state.spacing, 2.5e-3);
    return max(state.edge - max(bite, border_bay(state, bent)), 0.0);
}
float near_border(PaperState state, Bent bent, float width) {
    float distance_ = (1.0 - state.rim) * state.spacing;
    float uneven = 1.0 + 0.5 * bent.coarse + 0.6 * bent.medium + 0.4 * bent.fine;
    return min(1.0, 5.0 * state.rim) * (1.0 - stepf(0.1 * width, width * max(uneven, 0.2), distance_));
}
vec3 fibres_along(vec3 position, float stretch, float seed) {
    vec3 p = position;
    return vec3(stretch * p.x, p.y + FIBRE_WAVES * noise3(float3_scale(p, 70.0), seed), p.z);
}
float ash_on_char(PaperState state, Bent bent, float cloud, float strand, float fibre) {
    float cold = stepf(PAPER_WHOLE, 0.5, bent.burn) * (1.0 - stepf(520.0, 760.0, bent.temperature));
    if (cold <= 0.0) return 0.0;
    float border = 1e3 * border_distance(state, bent);
    float threads = 0.5 * strand + 0.3 * (fibre - 0.4), wide = max(0.9 + 1.6 * cloud, 0.35);
    float fringe = stepf(0.0, 4.2, state.age + 2.0 * cloud) * stepf(-0.9, 0.0, cloud + 0.4 * threads) *
                         min(1.0, 1.15 * exp(-border / wide) * (1.0 + threads));
    float skin =
        0.75 * stepf(0.53, 0.62, bent.burn) * stepf(2.0, 8.0, state.age) * stepf(-0.1, 1.25, cloud + 0.9 * threads);
    return cold * clamp(max(fringe, skin), 0.0, 1.0);
}
float ash_lace(Bent bent, float footprint) {
    return paper_noise(bent.position, 2.6, footprint, 15.0) + 0.25 * bent.fine - 0.45 * bent.coarse;
}
void ash_shade(PaperState state, Bent bent, float ink, inout Point point) {
    float size = point.footprint;
    if (bent.burn < PAPER_WHOLE) return;
    vec3 along =
        fibres_along(float3_mad(bent.position, vec3(bent.medium, bent.coarse, bent.fine), 0.45e-3), 0.14, 11.0);
    float cloud = 1.2 * paper_noise(bent.position, 12.0, size, 19.0), strand = paper_noise(along, 1.5, size, 20.0);
    float fibre = clamp(1.6 - size * 1400.0, 0.0, 1.0) * ridge(noise3(float3_scale(along, 2100.0), 12.0), 0.5);
    float plate = ash_on_char(state, bent, cloud, strand, fibre);
    float whole = ash_amount(bent);
    float amount = max(whole, min(2.2 * plate, 0.92));
    float dry = 1.0 - 0.4 * stepf(2.0, 9.0, state.age);
    point.gloss *= dry;
    point.mirror *= dry;
    if (amount <= 0.01) return;
    vec3 bowed = float3_mad(bent.position, vec3(bent.medium, bent.coarse, bent.fine), 1.1e-3);
    float large = ridge(paper_noise(bowed, 8.5, size, 14.0), 0.10);
    float small = ridge(paper_noise(float3_mad(bowed, vec3(1.0, -1.0, 1.0), 2e-3 * bent.coarse), 3.4, size, 18.0), 0.13);
    float vein = max(large, 0.55 * small);
    float pale = max(whole * stepf(1.0, 13.0, state.age + 4.0 * cloud), 0.85 * plate * plate);
    float rim = whole * stepf(0.25, 0.6, ash_lace(bent, size));
    float thin = max(rim, stepf(0.35, 0.95, state.rim + 0.25 * bent.fine));
    float value = mix(0.030, 0.42, pale) * (1.0 + 0.22 * strand + 0.22 * (fibre - 0.4) + 0.1 * bent.fine) +
                  (0.010 + 0.05 * pale) * cloud + (0.02 + 0.06 * pale) * vein;
    value += (0.03 + 0.07 * pale) * thin;
    float crackle = paper_cracks(bent, 4.2, 0.03, size);
    value *= 1.0 - 0.4 * crackle;
    value += (0.05 + 0.19 * pale) * ink * (1.0 - 0.3 * crackle);
    vec3 tone = mix(vec3(0.90, 0.98, 1.12), vec3(0.95, 1.0, 1.06), pale);
    vec3 grey = float3_scale(tone, clamp(value, 0.02, 0.64));
    point.albedo = mix(point.albedo, grey, amount);
    point.gloss *= 1.0 - 0.8 * amount;
    point.mirror = mix(point.mirror, 0.55 - 0.25 * pale + 0.2 * ink, amount);
    point.transmission = mix(point.transmission, 0.28 + 0.27 * thin, amount);
    vec3 folded = float3_mad(bent.position, vec3(bent.coarse, bent.medium, -bent.coarse), 0.8e-3);
    tilt(folded, 8.5, 0.55 * amount, true, 16.0, point);
    tilt(folded, 3.4, 0.26 * amount, true, 17.0, point);
}
float ember_air(vec3 p) {
    float t = seconds();
    float slow = noise3(vec3(21.0 * p.x + 0.8 * t, 21.0 * p.y - 0.5 * t, 21.0 * p.z - 1.7 * t), 51.0);
    float quick = noise3(vec3(55.0 * p.x, 55.0 * p.y, 55.0 * p.z - 7.0 * t), 52.0);
    return clamp(1.0 + 0.42 * slow + 0.22 * quick, 0.3, 1.7);
}
float ember_seen(float temperature) {
    float above = max(temperature - EMBER_HOT, 0.0), most = 160.0;
    return temperature - above + above * most / (above + most);
}
float line_life(Bent bent) {
    float t = seconds();
    vec3 drift = float3_add(float3_scale(bent.position, 190.0), vec3(0.5 * t, -0.35 * t, 0.8 * t));
    vec3 patch_ = float3_add(float3_scale(bent.position, 62.0), vec3(-0.12 * t, 0.2 * t, 0.15 * t));
    return stepf(-0.22, 0.62,
                 0.75 * noise3(drift, 21.0) + 0.5 * noise3(patch_, 22.0) + 0.35 * bent.medium + 0.2 * bent.fine);
}
vec3 ember_line(PaperState state, Bent bent, float air,
                         float footprint) {
    float activity = ember_activity(state.burn_rate);
    if (activity < 0.02 || state.temperature < BLACKBODY_MIN) return vec3(0.0, 0.0, 0.0);
    float life = line_life(bent) * min(air, 1.2);
    float distance_ = (bent.burn - EMBER_BURN) / max(state.gradient, 20.0);
    float width = EMBER_WIDTH * (0.22 + 0.9 * life * life), x = abs(distance_) / width;
    float profile = distance_ > 0.0 ? 0.72 * exp(-0.5 * x * x) + 0.28 * exp(-0.8 * x) : exp(-x * x);
    float temperature = ember_temperature(state.temperature) + 210.0 * (life - 0.6) + 60.0 * bent.fine;
    if (distance_ > 0.0) temperature -= 45.0 * min(x, 3.0);
    float strength = activity * profile * (0.05 + 0.95 * life * life) * (0.85 + 0.4 * bent.fine) * air;
    float near = 0.10 * activity * life * exp(-0.05 * x * x);
    if (near > 0.003) strength += near * paper_cracks(bent, 1.6, 0.12, footprint);
    return float3_scale(blackbody_glow(ember_seen(temperature)), EMBER_GAIN * max(strength, 0.0));
}
vec3 sparks(PaperState state, Bent bent, float air, float footprint) {
    float warm = stepf(420.0, 640.0, state.temperature) * stepf(0.76, 0.86, bent.burn);
    if (warm <= 0.0 || state.age <= 0.0) return vec3(0.0, 0.0, 0.0);
    float patch_ = stepf(0.10, 0.55, noise3(float3_scale(bent.position, 85.0), 24.0) + 0.3 * bent.medium);
    if (patch_ <= 0.0) return vec3(0.0, 0.0, 0.0);
    float delay = noise3(float3_scale(bent.position, 240.0), 23.0) + 0.5 * bent.medium + 0.25 * bent.fine;
    float late = (state.age - 3.2) * 0.28 - delay;
    float glow = warm * patch_ * air * exp(-70.0 * late * late) * clamp(1.6 - footprint * 900.0, 0.3, 1.0);
    return float3_scale(blackbody_glow(1035.0 + 50.0 * bent.fine), 1.5 * glow);
}
vec3 border_glow(PaperState state, Bent bent, float air) {
    if (state.burn < PAPER_WHOLE || state.age <= 0.0 || state.age > 12.0) return vec3(0.0, 0.0, 0.0);
    float warm = stepf(420.0, 560.0, state.temperature) * (1.0 - ember_activity(state.burn_rate));
    float near = warm > 0.0 ? near_border(state, bent, 0.6e-3) : 0.0;
    if (near <= 0.0) return vec3(0.0, 0.0, 0.0);
    float strength = near * warm * air * line_life(bent) * exp(-0.35 * state.age);
    return float3_scale(blackbody_glow(1090.0 - 22.0 * state.age + 50.0 * bent.fine), 2.5 * strength);
}
float leaf_alive(PaperState state, Bent bent, float patch_) {
    float t = seconds(), border = 1e3 * border_distance(state, bent);
    vec3 p = float3_mad(bent.position, vec3(bent.medium, bent.coarse, bent.fine), 0.5e-3);
    float stretch = noise3(float3_mad(vec3(0.05 * t, -0.08 * t, 0.11 * t), p, 1.0 / 17e-3), 61.0);
    float rim = stepf(-0.3, 0.5, stretch + 0.9 * patch_);
    float behind = rim * exp(-border / max(0.7 + 2.8 * rim * (0.9 + 0.6 * patch_), 0.3));
    float creeps = stepf(-0.1, 0.5, 0.35 * patch_ - stretch);
    if (creeps <= 0.0) return behind;
    float phase = 1.9 * noise3(float3_mad(vec3(0.0, 0.04 * t, 0.0), p, 1.0 / 24e-3), 63.0) +
                        0.6 * noise3(float3_scale(p, 1.0 / 7e-3), 64.0) + 0.11 * t;
    float since = phase - floor(phase);
    return max(behind, creeps * stepf(0.0, 0.05, since) * (0.75 * exp(-14.0 * since) + 0.25 * exp(-3.0 * since)));
}
vec3 leaf_glow(PaperState state, Bent bent, float air, float footprint) {
    float alone = ember_activity(state.glowing), starved = ember_starved(state.starved, bent.burn, alone);
    float activity = alone + starved;
    if (activity < 0.02 || ember_temperature(state.temperature) < BLACKBODY_MIN) return vec3(0.0, 0.0, 0.0);
    float fibre = paper_noise(fibres_along(bent.position, 0.25, 65.0), 0.5, footprint, 66.0);
    float t = seconds();
    float patch_ = noise3(float3_mad(vec3(-0.3 * t, 0.2 * t, 0.4 * t), bent.position, 1.0 / 4.4e-3), 62.0);
    float alive = leaf_alive(state, bent, patch_) * (1.0 - LEAF_STARVES * starved);
    float inward = (bent.burn - STARVED_BORDER) / (max(state.gradient, 20.0) * 2.0 * EMBER_WIDTH);
    alive = max(alive, LEAF_FRONT * starved * exp(-inward * inward));
    float coals = 0.45 * patch_ + 0.42 * bent.medium + 0.45 * fibre + 0.2 * bent.fine;
    float gathers =
        mix(LEAF_SCATTERS, 1.0, stepf(0.05, 0.5, alive));
    float lit = clamp(LEAF_SPREAD * alive + gathers * coals - 0.56, 0.0, 1.0),
                hot = lit * lit * (1.6 - 0.6 * lit);
    float temperature = ember_temperature(state.temperature) - STARVED_COOLER * starved;
    vec3 red = blackbody_glow(ember_seen(temperature - LEAF_COOLER * (1.5 - alive)));
    vec3 bright = blackbody_glow(ember_seen(temperature + mix(-LEAF_DIM, LEAF_CORE, hot)));
    vec3 glow = float3_scale(red, LEAF_DULL * alive * max(0.7 + 0.7 * coals, 0.1) * alone);
    return float3_scale(float3_mad(glow, bright, LEAF_BRIGHT * hot * activity), EMBER_GAIN * air);
}
void ember_shade(PaperState state, Bent bent, inout Point point) {
    if (state.burn < 0.2 || state.temperature < 420.0) return;
    float air = ember_air(point.position);
    vec3 glow = float3_add(ember_line(state, bent, air, point.footprint),
                             sparks(state, bent, air, point.footprint));
    glow = float3_add(glow, border_glow(state, bent, air));
    glow = float3_add(glow, leaf_glow(state, bent, air, point.footprint));
    point.glow = float3_scale(glow, 1.0 / (1.0 + max(glow.x, max(glow.y, glow.z)) / EMBER_MOST));
}
bool is_hole(PaperState state, Bent bent, float footprint) {
    if (state.burn > PAPER_WHOLE &&
        (state.rim > 1.0 - border_bite(state.burn, bent) || state.edge < border_bay(state, bent)))
        return true;
    return bent.burn > 0.7 && ash_amount(bent) * stepf(0.72, 0.95, ash_lace(bent, footprint)) > 0.5;
}
float flocks_of(PaperState state, inout Point point) {
    float flocks = paper_noise(askew(state.rest), 3.6, point.footprint, 5.0);
    point.through = float3_scale(vec3(1.18, 0.98, 0.70), 1.0 - 0.15 * flocks);
    return flocks;
}
vec3 print_seen(vec3 near, vec3 far, inout Point point) {
    vec3 seen = mix(vec3(1.0, 1.0, 1.0), far, min(3.0 * point.transmission * point.transmission, 0.95));
    point.through = float3_mul(point.through, vec3(far.x / seen.x, far.y / seen.y, far.z / seen.z));
    return float3_mul(near, seen);
}
float scorch_amount(PaperState state, Bent bent, float footprint) {
    float by_burn = 1.0 - exp(-7.5 * max(bent.burn, 0.0));
    float steep = state.heat_gradient / max(max(state.peak, state.temperature) - 293.0, 1.0);
    float near = stepf(120.0, 350.0, steep), first = mix(55.0, 5.0, near), last = mix(360.0, 200.0, near);
    float above = bent.peak - 293.0;
    if (above > 0.3 * first && by_burn < 0.9)
        above *= exp(clamp(2.5e-3 * steep, 0.7, 1.3) *
                      (paper_noise(bent.position, 9.0, footprint, 7.0) + 0.5 * bent.coarse + 0.2 * bent.medium));
    float by_heat = above > first ? 0.76 * min(log(above / first) / log(last / first), 1.0) : 0.0;
    return 1.0 - (1.0 - by_heat) * (1.0 - by_burn);
}
float ink_kept(Bent bent) {
    return mix(INK_LEAST, 1.0, stepf(-0.5, 0.35, bent.bays + 0.6 * bent.coarse + 0.3 * bent.medium));
}
void char_shade(Bent bent, vec3 burnt, float ink, inout Point point) {
    float black = stepf(0.12, 0.46, bent.burn);
    point.albedo = burnt;
    if (black <= 0.0) return;
    float value = 1.0 + 0.2 * bent.medium + 0.1 * bent.fine + 0.4 * bent.coarse;
    vec3 soot =
        mix(vec3(0.034, 0.020, 0.012), vec3(0.0118, 0.0125, 0.0145), stepf(0.22, 0.62, bent.burn));
    float craze = paper_cracks(bent, 3.1, 0.04, point.footprint);
    vec3 colour = float3_scale(soot, value * (1.0 - 0.6 * craze));
    point.albedo = mix(burnt, float3_mad(colour, vec3(0.072, 0.078, 0.088), ink), black);
    float tar = clamp(0.75 + 0.5 * bent.coarse - 0.5 * ink, 0.2, 1.2);
    point.gloss = 0.06 * black * tar;
    point.shininess = 14.0;
    point.mirror = 0.45 * black * tar;
    vec3 cockled = float3_mad(bent.position, vec3(bent.medium, bent.coarse, bent.fine), 0.7e-3);
    tilt(cockled, 13.0, 0.17 * black, true, 33.0, point);
    tilt(cockled, 5.2, 0.29 * black, true, 32.0, point);
    tilt(bent.position, 1.6, 0.09 * black, true, 31.0, point);
    float away = 1.0 - max(dot(point.normal, point.view), 0.0);
    float sheen =
        SHEEN * black * away * away * away * away * (1.0 - 0.5 * craze) * max(0.8 + 0.5 * bent.coarse, 0.2);
    point.albedo = float3_mad(point.albedo, vec3(0.90, 0.98, 1.08), sheen);
}
float light_mirrored(Point point) {
    float rest = 1.0 - max(dot(point.normal, point.view), 0.0), rest2 = rest * rest;
    return point.mirror * (0.06 + 0.54 * rest2 * rest2 * rest);
}
`;

export const FLAME = /* glsl */ `
const float FLAME_SEEN = 0.15;
const float FLAME_HEIGHT = 0.08;
const float FLAME_END = 0.3;
const float RISE_MOST = 0.55;
const float EDDY_RATE = 8.0;
const float SOOT_DENSE = 198.0;
const float FLAME_DIM = 0.26;
const float FLAME_BRIGHT = 5.9;
const float TAPER = 0.55;
const float FLAME_MOST = 2.0;
const float FIRE_SWAY = 0.027;
const float FIRE_WARP_WIDE = 0.0062;
const float FIRE_WARP_FINE = 0.0018;
const float SMOKE_WARP = 0.0234;
const float SMOKE_THIN = 0.2;
const float FIRE_OUTSIDE = -0.006;
const float SWAY_WIDE = 0.08;
const float SWAY_SMALL = 0.6;
const float SWAY_SHARE = 0.35;
const float SWAY_GAIN = 1.35;
const float SWAY_SLOPE = 0.55;
const float SMOKE_SEEN_AS = 76.0;
const float SMOKE_FULL = 0.6;
const float SMOKE_FILLS = 0.03;
const float SMOKE_EDDY = 0.032;
const float SMOKE_SMALL = 0.53;
const float SMOKE_BEND = 0.5;
const float SMOKE_FOLD = 0.055;
const float SMOKE_SOFT = 2.0;
const float SMOKE_GREY = 0.05;
const float SMOKE_SOFTEST = 8.0;
const float SMOKE_WIDENS = 1.0;
const float SMOKE_THINS = 2.0;
const float SMOKE_CALM = 0.5;
const float SMOKE_FINE = 0.65;
const float SMOKE_EVEN = 0.5;
const float SMOKE_THREADS = 1.5;
const float SMOKE_COARSE = 0.45;
const float SMOKE_DARK = 0.25;
const float SMOKE_SLOW = 0.4;
const float SMOKE_SPEED = 0.5;
const float BASE_SPEED = 0.25;
const float BUOYANCY = 2.0;
const float EDDY_WIDE = 0.0135;
const float EDDY_FINE = 0.0065;
const float FINE_OFTEN = 2.2;
const float EDDY_THREAD = 0.01;
const float THREAD_BLUR = 0.0016;
const float EDDY_FILAMENT = 0.009;
const float FOLD_SHARP = 2.2;
const float THREAD_WARP = 0.01;
const float ROLL = 0.5;
const float BLUE_DENSE = 3.6;
const float BLUE_ENDS = 0.005;
const float SHELL_RISE = 0.0005;
const float SHELL_RISE_MOST = 0.0016;
const float SHELL = 0.0018;
const float EDGE = 0.42;
const float STAND_OFF = 0.0006;
const float JOINED_HOT = 0.15;
const float LARGE_HOT = 0.14;
const float FILAMENT_HOT = 0.55;
const float HIGH_COOL = 0.18;
const float SPENT_COOL = 0.25;
const float SPENT_THIN = 0.4;
const float FOOT_CLEAR = 0.004;
const float FOOT_FULL = 0.027;
const float FOOT_SOOT = 0.0075;
const float FOOT_BESIDE = 0.0145;
const float FOOT_WARM = 0.015;
const float FOOT_LATE = 0.03;
const float FOOT_COOL = 0.65;
const float FOOT_GLOWS = 0.8;
const float FOOT_HIDES = 0.4;
const float FOOT_HAZE = 0.27;
const float TONGUE_MIDDLE = 0.05;
const float TONGUE_ENDS = 0.33;
const float TONGUE_ROOTED = 0.6;
const float BORDER_WIDE = 0.003;
const float BORDER_THIN = 0.4;
const float BORDER_GAIN = 1.25;
const float YOUNG_HOT = 0.5;
const float YOUNG_BEGINS = 0.006;
const float YOUNG_ENDS = 0.025;
const float FOOT_BORDER = 1.7;
const float FOOT_THIN = 0.25;
const float FOOT_GAIN = 1.45;
const float CORE_BEGINS = 0.003;
const float CORE_FULL = 0.024;
const float CORE_HIDES = 0.22;
const float SMOKE_STEP = 0.01;
const float FIRE_SOFT = 3.0;
struct FireCell { float flame; float rise; float smoke; float glow; };
struct FirePoint { vec3 soot; vec3 root; float depth; float profile; float shell; float opaque; };
struct Matter { vec3 light; float dense; };
struct Smoke { vec3 light; float dense; float fold; float old; };
struct Noise { float a; float b; float c; float d; };
Noise noise_at(vec3 q);
FireCell cell_at(vec3 p);
Noise eddies(vec3 p, float passed, float width, float often) {
    float c = 0.829, s = 0.559;
    float across = 1.0 / width;
    return noise_at(vec3((c * p.x - s * p.y) * across + 0.21 * passed,
                                (s * p.x + c * p.y) * across + 0.17 * passed, -often * passed));
}
float eddies_passed(float height, float z, float time) {
    float steady = (RISE_MOST * RISE_MOST - BASE_SPEED * BASE_SPEED) / (2.0 * BUOYANCY);
    float speed = sqrt(BASE_SPEED * BASE_SPEED + 2.0 * BUOYANCY * clamp(height, 0.0, steady));
    float risen = (speed - BASE_SPEED) / BUOYANCY + max(height - steady, 0.0) / RISE_MOST;
    float below = (z - height) / RISE_MOST + min(height, 0.0) / BASE_SPEED;
    return EDDY_RATE * (time - risen - below);
}
void shade_flame(float flame, vec3 p, float rise, float passed, float slope, Noise wide,
                               Noise fine, float blur, inout FirePoint point) {
    float torn = stepf(0.0, 0.02, rise);
    float tall = rise / (fireScale * FLAME_HEIGHT);
    float coarse = 0.075 + 0.425 * torn, small = 0.025 + 0.225 * torn;
    float edge = flame + coarse * (0.67 - 2.4 * abs(wide.c)) + small * (0.4 - 2.0 * abs(fine.c)) - EDGE -
                TAPER * (1.0 - exp(-tall)) - 0.1 * (1.0 - torn);
    edge = min(edge, 2.0 * (flame - FLAME_SEEN));
    float noisy = 2.0 * (coarse / EDDY_WIDE + small / EDDY_FINE) / fireScale;
    point.depth = max(edge / sqrt(slope * slope + 0.4 * noisy * noisy + 1.0), FIRE_OUTSIDE);
    if (!(point.depth > 0.0)) return;
    float tip = stepf(0.35, 1.4, tall), fill = mix(0.02, 0.12, tip);
    float first = clamp(blur, SHELL_RISE, SHELL_RISE_MOST * fireScale),
         outer = clamp(point.depth, 0.0, first), inner = max(point.depth - first, 0.0);
    float fading = (1.0 - fill) * exp(-inner / SHELL), same = (0.5 * SHELL_RISE + SHELL) / (0.5 * first + SHELL);
    point.profile = same * outer / first * (fill + fading);
    point.shell = same * (0.5 * outer * outer / first + fill * inner + SHELL * (1.0 - fill - fading));
    float foot = rise + 0.0012 * fine.d + 0.0016 * wide.d;
    float small_foot = min(fireScale, 1.0), range = FLAME_BRIGHT - FLAME_DIM;
    float above = stepf(small_foot * FOOT_CLEAR, small_foot * FOOT_FULL, rise);
    float tongue = 1.0 - stepf(TONGUE_MIDDLE, mix(TONGUE_ROOTED, TONGUE_ENDS, above),
                                      abs(wide.c) + 0.3 * abs(fine.c));
    float warm = stepf(0.0, small_foot * mix(FOOT_LATE, FOOT_WARM, tongue), foot);
    float dense = mix(mix(FOOT_HAZE, 1.0, tongue), 1.0, above);
    float soot = stepf(0.0, small_foot * mix(FOOT_BESIDE, FOOT_SOOT, tongue), foot);
    vec3 bent =
        float3_mad(p, vec3(wide.b + 0.2 * fine.b, wide.a + 0.2 * fine.a, 0.0), fireScale * THREAD_WARP);
    Noise thread = Noise(0.0, 0.0, 0.0, 0.0);
    if (soot > 0.0)
        thread = eddies(bent, passed + ROLL * wide.d, sqrt(fireScale) * EDDY_THREAD, 3.0 * sqrt(fireScale));
    float sharp =
        max(3.0 * min(THREAD_BLUR / max(blur, 1e-6), 1.0), 2.2);
    float clear = stepf(
        -0.5, 0.6, 0.15 * (wide.d + fine.d) + torn * (0.57 - 0.17 * (3.0 - sharp) - sharp * abs(thread.a)));
    float filament = 0.0, pane = 0.0;
    if (above > 0.0) {
        Noise n =
            eddies(bent, passed + ROLL * wide.d, sqrt(fireScale) * EDDY_FILAMENT, 2.0 * sqrt(fireScale));
        filament = above * min(1.5 * THREAD_BLUR / max(blur, 1e-6), 1.0) *
                   clamp(0.55 - 2.6 * max(n.a, -FOLD_SHARP * n.a) + 0.9 * n.b, -1.0, 1.0);
        pane = above * clamp(1.6 * n.d + 0.8 * thread.d, -1.0, 1.0);
    }
    float core = stepf(0.35, 0.7, flame) * stepf(CORE_BEGINS, CORE_FULL, rise);
    float strong = stepf(0.0, 0.7, edge), low = 1.0 - stepf(0.1, 0.9, tall);
    float hot = 0.14 * strong + (0.04 + 0.13 * core) * low + 0.25 * core + 0.74 * clear - 0.14 * tip - 0.138;
    hot += FILAMENT_HOT * filament + 0.15 * pane * (1.0 - clear) - HIGH_COOL * stepf(0.1, 1.5, tall);
    hot += JOINED_HOT * stepf(1.1, 1.6, flame);
    hot += LARGE_HOT * clamp(fireScale - 1.0, 0.0, 1.0);
    hot *= mix(FOOT_COOL, 1.0, warm);
    float body = stepf(-0.35, 0.1, flame - EDGE - TAPER * (1.0 - exp(-tall)));
    float spent = stepf(0.5, 1.6, tall) * (1.0 - body);
    hot = clamp(hot - SPENT_COOL * spent, 0.0, 1.0);
    soot *= (1.0 - SPENT_THIN * spent) * dense * stepf(2.0 * STAND_OFF, 6.0 * STAND_OFF, rise);
    float root = clamp((rise + STAND_OFF) / (8.0 * STAND_OFF), 0.0, 1.0) * (1.0 - soot) *
                (1.0 - stepf(BLUE_ENDS / 2.0, BLUE_ENDS, rise));
    float fold = (1.0 - clear) * (1.0 - clear) * mix(0.25, 1.0, above);
    soot *= 0.35 + 3.5 * fold * (1.0 + 0.7 * pane) + 1.2 * clear * clear + FOOT_GLOWS * tongue * (1.0 - above);
    float border = fireScale * BORDER_WIDE * mix(FOOT_BORDER, 1.0, above);
    soot *= mix(mix(FOOT_THIN, BORDER_THIN, above), 1.0, stepf(0.0, border, point.depth));
    soot *= BORDER_GAIN * mix(FOOT_GAIN, 1.0, above);
    soot *= (0.6 + 0.9 * torn * max(thread.b, -0.5)) * (1.0 - 0.75 * tip) * (1.0 + 0.95 * filament);
    float seen = max(hot, YOUNG_HOT * (1.0 - stepf(YOUNG_BEGINS, YOUNG_ENDS, rise)));
    soot *= (FLAME_DIM + range * hot * hot * hot) / (FLAME_DIM + range * seen * seen * seen);
    point.opaque = SOOT_DENSE * soot * mix(FOOT_HIDES, 1.0 + CORE_HIDES * core, above);
    point.soot = float3_scale(flame_colour(seen), SOOT_DENSE * soot);
    point.root = float3_scale(vec3(0.28, 0.56, 1.18), BLUE_DENSE * root);
}
void fire_sway(vec3 p, float height, inout float sway[2]) {
    float scale = fireScale, most = min(SWAY_SLOPE * max(height, 0.0), FIRE_SWAY * scale);
    float passed = EDDY_RATE * (fireMoment / sqrt(scale) - p.z / (scale * RISE_MOST));
    Noise wide = eddies(p, passed, scale * SWAY_WIDE, 0.85);
    Noise small = eddies(p, passed, scale * SWAY_SMALL * SWAY_WIDE, 1.1);
    sway[0] = most * clamp(SWAY_GAIN * (wide.a + SWAY_SHARE * small.a), -1.0, 1.0);
    sway[1] = most * clamp(SWAY_GAIN * (wide.b + SWAY_SHARE * small.b), -1.0, 1.0);
}
void fire_between(FirePoint a, FirePoint b, float step_, inout Matter matter) {
    if (!(a.depth > 0.0 || b.depth > 0.0)) return;
    float apart = b.depth - a.depth, part = 0.5 * (a.profile + b.profile);
    if (abs(apart) > 5e-5) part = min(abs(b.shell - a.shell) / min(abs(apart), step_), 1.0);
    float from = a.depth > b.depth ? 0.5 + 0.5 * float(b.depth <= 0.0) : 0.5 * float(a.depth > 0.0);
    from = 1.0 - from;
    vec3 light = float3_add(mix(a.soot, b.soot, from), mix(a.root, b.root, from));
    matter.light = float3_mad(matter.light, light, part);
    matter.dense += part * mix(a.opaque, b.opaque, from);
}
Smoke fire_smoke_at(vec3 p) {
    float eddy = fireScale * SMOKE_EDDY, small = SMOKE_SMALL * eddy, warp = fireScale * SMOKE_WARP;
    Noise wide = eddies(p, (SMOKE_SLOW * fireMoment - p.z) / eddy, eddy, 0.72);
    vec3 by = vec3(wide.a, wide.b, wide.c);
    FireCell cell = cell_at(float3_mad(p, by, warp));
    float near = cell.glow / (cell.glow + SMOKE_GREY), moves = mix(SMOKE_CALM, 1.0, near);
    vec3 moved = float3_mad(p, by, moves * warp);
    float passed = (SMOKE_SPEED * fireMoment - moved.z) / eddy, bend = moves * SMOKE_BEND * warp;
    Noise curl = eddies(moved, passed, small, 0.7);
    moved = float3_mad(moved, vec3(curl.a, curl.b, curl.c), bend);
    float turned = passed - bend * curl.c / eddy;
    float here = eddies(moved, turned, small, 0.8).d,
                below = eddies(moved, turned + 0.25, small, 0.8).d;
    float fold = mix(wide.d, here, mix(SMOKE_COARSE, SMOKE_FINE, near)), up = 2.0 * (here - below);
    float down = clamp(up - 12.0 * fold * up, -1.0, 1.0);
    vec3 warm = mix(vec3(0.78, 0.8, 0.83), vec3(1.0, 0.45, 0.14), near);
    vec3 glow = float3_scale(warm, cell.glow / (1.0 + cell.glow / SMOKE_DARK));
    Smoke smoke;
    vec3 day = float3_mul(fireDaylight, mix(vec3(1.0, 1.0, 1.0), vec3(0.62, 0.46, 0.34), near));
    smoke.light = float3_mad(float3_scale(day, 0.33 - 0.2 * down), glow, 1.8 + 1.5 * down);
    smoke.dense = SMOKE_SEEN_AS * cell.smoke * stepf(SMOKE_THIN, SMOKE_FULL, cell.smoke) *
                  stepf(-0.35, 0.35, wide.d + SMOKE_FILLS * cell.smoke) * (1.0 - stepf(0.05, 0.4, cell.flame));
    smoke.dense *= SMOKE_EVEN + SMOKE_THREADS * max(1.0 - 2.2 * abs(curl.d), 0.0);
    smoke.fold = fold;
    smoke.old = 1.0 - near;
    return smoke;
}
float fold_sum(float x, float soft) {
    float edge = clamp(1.0 + x, 0.0, 1.0), left = clamp(1.0 - x / soft, 0.0, 1.0);
    return (edge * edge * edge + (x > 0.0 ? soft * (1.0 - left * left * left) : 0.0)) / 3.0;
}
float fold_sum_twice(float x, float soft) {
    float edge = clamp(1.0 + x, 0.0, 1.0), left = clamp(1.0 - x / soft, 0.0, 1.0), left2 = left * left;
    float edge2 = edge * edge, behind = max(x, 0.0);
    return edge2 * edge2 / 12.0 + (1.0 + soft) * behind / 3.0 - soft * soft * (1.0 - left2 * left2) / 12.0;
}
Matter fire_smoke_between(Smoke a, Smoke b, float blur) {
    if (a.dense + b.dense <= 0.0) return Matter(vec3(0.0, 0.0, 0.0), 0.0);
    float old = 0.5 * (a.old + b.old), soft = mix(SMOKE_SOFT, SMOKE_SOFTEST, old);
    float sharp = SMOKE_FOLD * (1.0 + SMOKE_WIDENS * old);
    float width = sharp + 1.2 * blur / (fireScale * SMOKE_EDDY), first = a.fold / width;
    float apart = b.fold / width - first;
    apart = abs(apart) > 0.02 ? apart : 0.02;
    float last = first + apart, sum = fold_sum(last, soft), mean = (sum - fold_sum(first, soft)) / apart;
    float end = 0.5 * mean;
    if (abs(apart) > 0.1) end = (sum - (fold_sum_twice(last, soft) - fold_sum_twice(first, soft)) / apart) / apart;
    float dense = (a.dense * (mean - end) + b.dense * end) * sharp / (width * (1.0 + SMOKE_THINS * old));
    return Matter(float3_scale(mix(a.light, b.light, 0.5), dense), dense);
}
`;
