// Small pieces of text: formatted strings, JSON out and in.
#pragma once

#include <stdbool.h>
#include <stdio.h>

#include "singe/base.h"

/// A formatted string from malloc. The program ends with EXIT_FAILED when out of memory.
char *text_format(const char *format, ...) SINGE_PRINTF(1, 2);

/// An argument, quoted for a shell if necessary, from malloc.
char *text_shell_quote(const char *text);

/// Closes a stream of open_memstream (NULL if it could not be opened). Returns whether *text is complete; the caller
/// frees it either way.
SINGE_NODISCARD bool text_stream_end(FILE *stream, char **text);

/// A stream into a text from malloc, and its end. The program ends with EXIT_FAILED when out of memory.
FILE *text_open(char **text);
void text_close(FILE *stream, char **text);

/// Writes a JSON string with its quotes. Bytes that are not UTF-8, which file names may contain, become \udc80 to
/// \udcff: the output is always UTF-8, and text_json_unquote returns the same bytes (as do Python's file names).
void text_json_string(FILE *file, const char *text);

/// Writes a cell of a CSV table, quoted if necessary.
void text_csv_cell(FILE *file, const char *text);

/// Writes a number that reads back exactly, or null if it is not finite.
void text_json_number(FILE *file, double number);

/// A value within a text of JSON.
typedef struct JsonText {
    const char *text;
    size_t size;
} JsonText;

/// Finds the value of a member of an object. False if there is no such member or the text up to it is not JSON.
bool text_json_member(JsonText object, const char *name, JsonText *value);

/// The bytes of a JSON string, from malloc; NULL if the value is none. The program ends with EXIT_FAILED when out of
/// memory.
char *text_json_unquote(JsonText value);

/// The bytes of a member that is a string, as text_json_unquote; NULL if there is none.
char *text_json_words(JsonText object, const char *name);

/// A member that is a whole number from 1 to 1000000, as of frames; 0 if there is none.
int text_json_count(JsonText object, const char *name);
