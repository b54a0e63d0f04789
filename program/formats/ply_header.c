// The header of PLY files: formats, elements and their properties.
#include "formats/ply.h"

#include "common/store.h"
#include "formats/number.h"

#include <stdarg.h>
#include <stdio.h>

// Each name is compared with all earlier ones.
enum { PLY_ELEMENT_LIMIT = 100, PLY_PROPERTY_LIMIT = 1000 };

// Each type has an old and a new name.
static const struct {
    const char *name, *other;
    size_t size;
} ply_types[PLY_TYPE_COUNT] = {
    {"char", "int8", 1}, {"uchar", "uint8", 1}, {"short", "int16", 2},   {"ushort", "uint16", 2},
    {"int", "int32", 4}, {"uint", "uint32", 4}, {"float", "float32", 4}, {"double", "float64", 8},
};

size_t ply_type_size(PlyType type) { return ply_types[type].size; }

SingeResult ply_refuse(const Ply *ply, SingeResult code, const char *format, ...) {
    char what[320];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    long long byte = (long long)(ply->text.at - ply->begin);
    if (ply->text.line > 0)
        return refuse(ply->error, code, "ply", ply->text.line, "%s:%lld: %s", short_name(ply->name),
                      (long long)ply->text.line, what);

    return refuse(ply->error, code, "ply", byte, "%s: byte %lld: %s", short_name(ply->name), byte, what);
}

const PlyElement *ply_element(const Ply *ply, const char *name) {
    for (size_t i = 0; i < ply->header.element_count; i++) {
        const PlyElement *element = &ply->header.elements[i];
        if (text_word_is(element->name, element->name_end, name)) return element;
    }
    return NULL;
}

// ---- header lines

typedef struct Word {
    const uint8_t *begin, *end;
} Word;

static Word ply_word(Ply *ply) {
    text_skip_blanks(&ply->text);
    Word word = {ply->text.at, text_word_end(&ply->text)};
    ply->text.at = word.end;
    return word;
}

static bool word_is(Word word, const char *text) { return text_word_is(word.begin, word.end, text); }

static bool word_same(Word a, const uint8_t *begin, const uint8_t *end) {
    return a.end - a.begin == end - begin && memcmp(a.begin, begin, (size_t)(end - begin)) == 0;
}

static SingeResult ply_header_name(Ply *ply, Word *word) {
    *word = ply_word(ply);
    if (word->begin == word->end) return ply_refuse(ply, SINGE_ERROR_FORMAT, "a name is missing");
    for (const uint8_t *p = word->begin; p < word->end; p++)
        if (*p < 32 || *p == 127) return ply_refuse(ply, SINGE_ERROR_FORMAT, "a name contains a control character");
    if (word->end - word->begin > 200) return ply_refuse(ply, SINGE_ERROR_FORMAT, "a name is longer than 200 bytes");
    return SINGE_OK;
}

static SingeResult ply_header_type(Ply *ply, Word word, PlyType *type) {
    for (int i = 0; i < PLY_TYPE_COUNT; i++)
        if (word_is(word, ply_types[i].name) || word_is(word, ply_types[i].other)) {
            *type = (PlyType)i;
            return SINGE_OK;
        }
    return ply_refuse(ply, SINGE_ERROR_FORMAT, "a PLY type is missing");
}

static SingeResult ply_header_element(Ply *ply) {
    PlyHeader *header = &ply->header;
    Word name;
    TRY(ply_header_name(ply, &name));
    if (header->element_count >= PLY_ELEMENT_LIMIT)
        return ply_refuse(ply, SINGE_ERROR_LIMIT, "more than %d kinds of elements", PLY_ELEMENT_LIMIT);

    for (size_t i = 0; i < header->element_count; i++)
        if (word_same(name, header->elements[i].name, header->elements[i].name_end))
            return ply_refuse(ply, SINGE_ERROR_FORMAT, "an element is declared twice");

    Word number = ply_word(ply);
    const uint8_t *at = number.begin;
    int64_t count;
    NumberStatus status = number_integer(&at, number.end, &count);
    if (status == NUMBER_JUNK || (status == NUMBER_OK && (at != number.end || count < 0)))
        return ply_refuse(ply, SINGE_ERROR_FORMAT, "the line has no count of elements");
    if (status == NUMBER_RANGE || count > MESH_COUNT_LIMIT)
        return ply_refuse(ply, SINGE_ERROR_LIMIT, "too many elements");
    if (!store_grow(ply->allocator, &header->elements, &header->element_capacity, header->element_count + 1,
                    sizeof(PlyElement)))
        return refuse_memory(ply->error, "ply", ply->name);

    header->elements[header->element_count++] =
        (PlyElement){name.begin, name.end, (uint32_t)count, header->property_count, 0};
    return SINGE_OK;
}

static SingeResult ply_header_property(Ply *ply) {
    PlyHeader *header = &ply->header;
    if (header->element_count == 0) return ply_refuse(ply, SINGE_ERROR_FORMAT, "a property before any element");

    PlyElement *element = &header->elements[header->element_count - 1];
    PlyProperty property = {0};
    Word word = ply_word(ply), name;
    property.is_list = word_is(word, "list");

    if (property.is_list) {
        TRY(ply_header_type(ply, ply_word(ply), &property.count_type));
        if (property.count_type >= PLY_FLOAT32)
            return ply_refuse(ply, SINGE_ERROR_FORMAT, "the length of a list must have an integer type");
        word = ply_word(ply);
    }

    TRY(ply_header_type(ply, word, &property.type));
    TRY(ply_header_name(ply, &name));
    if (element->property_count >= PLY_PROPERTY_LIMIT)
        return ply_refuse(ply, SINGE_ERROR_LIMIT, "more than %d properties", PLY_PROPERTY_LIMIT);

    for (size_t i = element->first_property; i < header->property_count; i++)
        if (word_same(name, header->properties[i].name, header->properties[i].name_end))
            return ply_refuse(ply, SINGE_ERROR_FORMAT, "a property is declared twice");
    property.name = name.begin;
    property.name_end = name.end;
    if (!store_grow(ply->allocator, &header->properties, &header->property_capacity, header->property_count + 1,
                    sizeof property))
        return refuse_memory(ply->error, "ply", ply->name);

    header->properties[header->property_count++] = property;
    element->property_count++;
    return SINGE_OK;
}

/// Counts are checked against the size of the file before memory is allocated.
static SingeResult ply_check_counts(const Ply *ply) {
    const PlyHeader *header = &ply->header;
    uint64_t left = (uint64_t)(ply->text.end - ply->text.at) + (header->format == PLY_ASCII);

    for (size_t i = 0; i < header->element_count; i++) {
        const PlyElement *element = &header->elements[i];
        uint64_t min = 0;
        for (size_t k = 0; k < element->property_count; k++) {
            const PlyProperty *property = &header->properties[element->first_property + k];
            if (header->format == PLY_ASCII) min += 2; // a digit and a separator
            else min += ply_type_size(property->is_list ? property->count_type : property->type);
        }

        // the product is below 2^31 * 8000
        if (min * element->count > left)
            return ply_refuse(ply, SINGE_ERROR_FORMAT, "the file is too short for its %u elements of kind %zu",
                              element->count, i + 1);
        left -= min * element->count;
    }

    return SINGE_OK;
}

SingeResult ply_read_header(Ply *ply) {
    Text *text = &ply->text;
    if (text->at == text->end) return ply_refuse(ply, SINGE_ERROR_FORMAT, "the file is empty");
    if (!word_is(ply_word(ply), "ply") || text_end_length(text->at, text->end) == 0)
        return ply_refuse(ply, SINGE_ERROR_FORMAT, "not a PLY file: it must begin with a line \"ply\"");

    bool known = false, ended = false;

    // the first line shows how lines end: after a lone CR, a first body byte of 10 is not part of the line end
    bool lone_return = text_end_length(text->at, text->end) == 1 && *text->at == '\r';
    while (!ended) {
        text->at += lone_return ? 1 : text_end_length(text->at, text->end);
        text->line++;

        Word word = ply_word(ply);
        ended = word_is(word, "end_header");
        if (word_is(word, "comment") || word_is(word, "obj_info")) {
            text_skip_blanks(&ply->text);
            const uint8_t *begin = ply->text.at;
            while (!text_at_line_end(&ply->text)) ply->text.at++;
            if (!ply->header.note && ply->text.at - begin > 6 && memcmp(begin, "singe ", 6) == 0) {
                ply->header.note = begin;
                ply->header.note_end = ply->text.at;
            }
        } else if (word_is(word, "format")) {
            static const char *const formats[] = {"ascii", "binary_little_endian", "binary_big_endian"};
            Word name = ply_word(ply), version = ply_word(ply);
            if (known) return ply_refuse(ply, SINGE_ERROR_FORMAT, "the format is declared twice");

            for (int i = 0; i < 3; i++)
                if (word_is(name, formats[i])) {
                    ply->header.format = (PlyFormat)i;
                    known = true;
                }

            if (!known) return ply_refuse(ply, SINGE_ERROR_FORMAT, "this is not a PLY format");
            if (!word_is(version, "1.0"))
                return ply_refuse(ply, SINGE_ERROR_FORMAT, "only PLY version 1.0 is supported");
        } else if (word_is(word, "element")) TRY(ply_header_element(ply));
        else if (word_is(word, "property")) TRY(ply_header_property(ply));
        else if (!ended) return ply_refuse(ply, SINGE_ERROR_FORMAT, "this is not a line of a PLY header");

        text_skip_blanks(&ply->text);
        if (!text_at_line_end(&ply->text)) return ply_refuse(ply, SINGE_ERROR_FORMAT, "too many words on the line");
        if (ply->text.at == ply->text.end) return ply_refuse(ply, SINGE_ERROR_FORMAT, "the header is truncated");
    }

    if (!known) return ply_refuse(ply, SINGE_ERROR_FORMAT, "the header has no format line");
    text->at += lone_return ? 1 : text_end_length(text->at, text->end);
    text->line++;
    if (ply->header.format != PLY_ASCII) text->line = 0;

    return ply_check_counts(ply);
}

void ply_header_free(Ply *ply) {
    PlyHeader *header = &ply->header;
    store_free(ply->allocator, header->elements, header->element_capacity, sizeof *header->elements);
    store_free(ply->allocator, header->properties, header->property_capacity, sizeof *header->properties);
    memset(header, 0, sizeof *header);
}
