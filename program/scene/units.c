#include "scene/units.h"

#include <math.h>
#include <string.h>

#include "formats/number.h"

#define PI 3.14159265358979323846

typedef struct Unit {
    const char *name;
    double factor, offset; // held = factor * (number + offset)
} Unit;

enum { UNIT_MAX = 6 };

typedef struct DimensionRow {
    const char *name;
    Unit units[UNIT_MAX]; // the first is the unit of bare numbers
} DimensionRow;

static const DimensionRow dimensions[DIM_COUNT] = {
    [DIM_NONE] = {"number", {{"", 1, 0}}},
    [DIM_FRACTION] = {"fraction", {{"", 1, 0}, {"%", 0.01, 0}}},
    [DIM_TEMPERATURE] = {"temperature", {{"K", 1, 0}, {"C", 1, 273.15}, {"F", 5.0 / 9.0, 459.67}}},
    [DIM_TEMPERATURE_DIFFERENCE] = {"temperature difference", {{"K", 1, 0}}},
    [DIM_LENGTH] = {"length", {{"m", 1, 0}, {"cm", 1e-2, 0}, {"mm", 1e-3, 0}, {"um", 1e-6, 0}, {"in", 0.0254, 0}}},
    [DIM_AREA] = {"area", {{"m2", 1, 0}, {"cm2", 1e-4, 0}, {"mm2", 1e-6, 0}}},
    [DIM_TIME] = {"time", {{"s", 1, 0}, {"ms", 1e-3, 0}, {"min", 60, 0}}},
    [DIM_ANGLE] = {"angle", {{"deg", PI / 180, 0}, {"rad", 1, 0}}},
    [DIM_SPEED] = {"speed", {{"m/s", 1, 0}, {"cm/s", 1e-2, 0}, {"mm/s", 1e-3, 0}}},
    [DIM_ACCELERATION] = {"acceleration", {{"m/s2", 1, 0}}},
    [DIM_GRAMMAGE] = {"mass per area", {{"kg/m2", 1, 0}, {"g/m2", 1e-3, 0}}},
    [DIM_DENSITY] = {"density", {{"kg/m3", 1, 0}, {"g/cm3", 1e3, 0}}},
    [DIM_FLUX] = {"heat flux", {{"W/m2", 1, 0}, {"kW/m2", 1e3, 0}}},
    [DIM_CONDUCTANCE] = {"heat transfer coefficient", {{"W/(m2 K)", 1, 0}, {"W/m2/K", 1, 0}, {"kW/(m2 K)", 1e3, 0}}},
    [DIM_SPECIFIC_HEAT] = {"specific heat", {{"J/(kg K)", 1, 0}, {"kJ/(kg K)", 1e3, 0}}},
    [DIM_SPECIFIC_ENERGY] = {"heat of combustion", {{"J/kg", 1, 0}, {"kJ/kg", 1e3, 0}, {"MJ/kg", 1e6, 0}}},
    [DIM_DIFFUSIVITY] = {"diffusivity", {{"m2/s", 1, 0}, {"cm2/s", 1e-4, 0}, {"mm2/s", 1e-6, 0}}},
    [DIM_RATE] = {"rate", {{"1/s", 1, 0}, {"1/min", 1.0 / 60.0, 0}}},
    [DIM_RATE_PER_KELVIN] = {"rate per kelvin", {{"1/(K s)", 1, 0}}},
    [DIM_CURVATURE] = {"curvature", {{"1/m", 1, 0}, {"1/cm", 100, 0}, {"1/mm", 1e3, 0}}},
    [DIM_COMPLIANCE] = {"compliance", {{"m/N", 1, 0}, {"mm/N", 1e-3, 0}}},
    [DIM_STIFFNESS] = {"stiffness", {{"N/m", 1, 0}, {"N/mm", 1e3, 0}}},
    [DIM_MOLAR_ENERGY] = {"energy per amount", {{"J/mol", 1, 0}, {"kJ/mol", 1e3, 0}}},
    [DIM_POWER] = {"power", {{"W", 1, 0}, {"kW", 1e3, 0}}},
    [DIM_WETTING] = {"mass per area and time", {{"kg/(m2 s)", 1, 0}, {"g/(m2 s)", 1e-3, 0}}},
    [DIM_BENDING] = {"bending stiffness", {{"N m", 1, 0}, {"mN m", 1e-3, 0}, {"uN m", 1e-6, 0}}},
    [DIM_FRAME_RATE] = {"frame rate", {{"1/s", 1, 0}, {"fps", 1, 0}, {"Hz", 1, 0}}},
};

/// Other spellings of parts of unit names. Longer spellings come first.
static const struct Spelling {
    const char *piece, *text;
} spellings[] = {
    {"deg", "\u00b0"}, {"C", "\u00b0C"}, {"F", "\u00b0F"}, {"u", "\u00b5"}, {"u", "\u03bc"},
    {"2", "\u00b2"},   {"2", "^2"},      {"3", "\u00b3"},  {"3", "^3"},     {" ", "\u00b7"},
    {" ", "*"},        {" ", " "},       {" ", ""},
};

static bool begins(const char *text, const char *with) { return strncmp(text, with, strlen(with)) == 0; }

/// Whether all of `text` spells the unit. Blanks count: "m m" is no "mm".
static bool unit_spelt(const char *text, const char *name) {
    while (*name) {
        if (*text == *name) {
            text++;
            name++;
            continue;
        }

        size_t i = 0, count = sizeof spellings / sizeof *spellings;
        while (i < count && !(begins(name, spellings[i].piece) && begins(text, spellings[i].text))) i++;
        if (i == count) return false;
        name += strlen(spellings[i].piece);
        text += strlen(spellings[i].text);
    }

    return !*text;
}

NumberFault quantity_read(const char *text, Dimension dimension, double *value) {
    const uint8_t *at = (const uint8_t *)text;
    double bare = 0;
    if (number_double(&at, at + strlen(text), &bare) != NUMBER_OK) return NUMBER_NOT_ONE;

    // without a unit it is in the dimension's first
    const char *spelt = (const char *)at + strspn((const char *)at, " ");
    const Unit *units = dimensions[dimension].units;
    int i = 0;

    while (*spelt && i < UNIT_MAX && units[i].name && !unit_spelt(spelt, units[i].name)) i++;
    if (i == UNIT_MAX || !units[i].name) return NUMBER_BAD_UNIT;

    *value = units[i].factor * (bare + units[i].offset);
    return NUMBER_GOOD;
}

const char *quantity_unit(Dimension dimension) { return dimensions[dimension].units[0].name; }

const char *quantity_name(Dimension dimension) { return dimensions[dimension].name; }

const char *quantity_article(Dimension dimension) {
    return strchr("aeiou", dimensions[dimension].name[0]) ? "an" : "a";
}

void quantity_units(Dimension dimension, char *buffer, size_t size) {
    size_t used = 0;
    buffer[0] = 0;
    for (int i = 0; i < UNIT_MAX && dimensions[dimension].units[i].name && used < size; i++)
        if (dimensions[dimension].units[i].name[0])
            used += (size_t)snprintf(buffer + used, size - used, "%s%s", used ? ", " : "",
                                     dimensions[dimension].units[i].name);
}

void quantity_print(float value, Dimension dimension, char *buffer, size_t size) {
    const double bare = (double)value / dimensions[dimension].units[0].factor, magnitude = fabs(bare);
    int whole = 1;
    for (double limit = 10; limit <= magnitude; limit *= 10) whole++;

    for (int digits = 1; digits <= 17; digits++) {
        // %g turns 1200 into 1.2e+03; plain notation is preferred if it is as short
        if (magnitude >= 1 && magnitude < 1e9)
            snprintf(buffer, size, "%.*f", digits > whole ? digits - whole : 0, bare);
        else snprintf(buffer, size, "%.*g", digits, bare);

        // a point in place of the locale's decimal sign, which may be several bytes
        char *to = buffer;
        for (const char *c = buffer; *c; c++) {
            if (strchr("0123456789eE+-", *c)) *to++ = *c;
            else if (to == buffer || to[-1] != '.') *to++ = '.';
        }
        *to = 0;

        double again = 0;
        if (quantity_read(buffer, dimension, &again) == NUMBER_GOOD && (float)again == value) return;
    }
}
