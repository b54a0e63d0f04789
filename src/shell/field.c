#include "shell/field.h"

bool field_create(Memory *memory, Field *field, float value) {
    *field = (Field){0};
    if (!NEW(memory, field->values, FIELD_RUN)) return false;
    for (int i = 0; i < FIELD_RUN; i++) field->values[i] = value;
    return true;
}

bool field_vary(Memory *memory, Field *field, uint32_t count) {
    float *values, value = field->values[0];
    if (field->mask) return true;
    if (!NEW(memory, values, count)) return false;
    for (uint32_t i = 0; i < count; i++) values[i] = value;
    FREE(memory, field->values, FIELD_RUN);
    *field = (Field){values, UINT32_MAX};
    return true;
}

void field_free(Memory *memory, Field *field, uint32_t count) {
    FREE(memory, field->values, field->mask ? count : FIELD_RUN);
    field->mask = 0;
}
