// Small pieces of text: formatted strings, JSON out and in.
#ifndef CLI_TEXT_H
#define CLI_TEXT_H

#include <stdbool.h>
#include <stdio.h>

#include "singe/base.h"

/// A formatted string from malloc. Without memory for it the program ends with EXIT_FAILED.
char *text_format(const char *format, ...) SINGE_PRINTF(1, 2);

/// An argument quoted for a shell where it must be, from malloc.
char *text_shell_quote(const char *text);

/// Ends a stream of open_memstream, or NULL where it could not be opened. Whether *text has all that was written; the
/// caller frees it either way.
SINGE_NODISCARD bool text_stream_end(FILE *stream, char **text);

/// Writes a JSON string with its quotes. Bytes that are no UTF-8, as names of files may have, become \udc80 to
/// \udcff: what is written is UTF-8 whatever the text is, and text_json_unquote gives the same bytes back (and so do
/// the file names of Python).
void text_json_string(FILE *file, const char *text);

/// Writes a cell of a CSV table, quoted where it must be.
void text_csv_cell(FILE *file, const char *text);

/// Writes a number that reads back exactly, or null where it is not finite.
void text_json_number(FILE *file, double number);

/// Finds the value of a member of the object that `json` holds. False where there is no such member or the
/// text is not JSON up to it.
bool text_json_member(const char *json, size_t size, const char *name, const char **value, size_t *value_size);

/// The bytes of a JSON string value, from malloc; NULL when it is not one. Without memory for it the program ends with
/// EXIT_FAILED.
char *text_json_unquote(const char *value, size_t size);

#endif
