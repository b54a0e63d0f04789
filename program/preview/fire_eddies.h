// Noise of eddies, for one position or for many: the file that includes it has defined Real, a float or as many as are
// computed at once, Real3 and real3, Noise, four Real, and noise_at.

/// Noise of eddies `width` across, of which `often` pass where one of the largest does; rotated away from the axes.
static inline Noise eddies(const Fire *fire, Real3 p, Real passed, float width, float often) {
    const float c = 0.829f, s = 0.559f; // 34 degrees around the vertical
    float across = 1 / width;
    return noise_at(fire, real3((c * p.x - s * p.y) * across + 0.21f * passed,
                                (s * p.x + c * p.y) * across + 0.17f * passed, -often * passed));
}
