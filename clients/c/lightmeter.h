/* A renderer's side of lightmeter.protocol/1 in one file of C99 that C++ takes too, without dependencies. In one source file:
 *
 *     #define LIGHTMETER_IMPLEMENTATION
 *     #include "lightmeter.h"
 *
 *     static void fog_exp(const lightmeter_case *asked, float *out)
 *     {
 *         const float *p = lightmeter_input(asked, "p", 3), *density = lightmeter_input(asked, "density", 1);
 *         out[0] = expf(-density[0] * fabsf(p[2]));
 *         ...
 *     }
 *
 *     static const lightmeter_formula formulas[] = {{"fog/exp", 4, fog_exp}};
 *
 *     int main(void) { return lightmeter_serve("my-renderer", "1.0", formulas, 1); }
 *
 * and then `lightmeter gate --exec ./my-renderer fog/exp`. `lightmeter list --formulas` names the inputs of each formula and the outputs,
 * which an answer has one after the other. Cases are asked in binary batches where the processor is little-endian, and else line by line.
 * Scenes, blend units and special values are asked in lines as well (docs/protocol.md); this file answers formulas.
 */
#ifndef LIGHTMETER_H
#define LIGHTMETER_H

#include <stddef.h>

/* Both halves of this file are C99, and C++ as well. */
#ifdef __cplusplus
extern "C" {
#endif

#define LIGHTMETER_PROTOCOL "lightmeter.protocol/1"
/* A line of the protocol is 1 MiB at most. */
#define LIGHTMETER_LINE (1 << 20)
/* Inputs of a formula, the numbers of all of them together, and the numbers of an answer, at most. */
#define LIGHTMETER_INPUTS 32
#define LIGHTMETER_NUMBERS 128
#define LIGHTMETER_OUTPUTS 32
/* Characters of a name or an id. */
#define LIGHTMETER_NAME 256

typedef struct {
    char id[LIGHTMETER_NAME];
    char formula[LIGHTMETER_NAME];
    struct {
        char name[LIGHTMETER_NAME];
        size_t first, count;
    } inputs[LIGHTMETER_INPUTS];
    size_t input_count, number_count;
    float numbers[LIGHTMETER_NUMBERS];
    /* What is wrong with the case, which is then answered as an error; empty where nothing is. */
    char error[LIGHTMETER_NAME];
} lightmeter_case;

typedef struct {
    const char *id;
    /* How many numbers the outputs have together. */
    size_t outputs;
    void (*answer)(const lightmeter_case *asked, float *out);
} lightmeter_formula;

/* The numbers of an input, of which there are `count`. Where the formula has no such input, zeros, and the case is answered as an error. */
const float *lightmeter_input(const lightmeter_case *asked, const char *name, size_t count);

/* Where the code of a formula stands: the file as it is called from the root of the repository, and the line, 0 for the whole file. */
typedef struct {
    /* An id or a filter. */
    const char *id;
    const char *file;
    unsigned line;
} lightmeter_source;

/* What a renderer says of itself. All but the name may be NULL. */
typedef struct {
    const char *name, *version;
    /* What it computes on, and the driver of that, as reports are to show them. */
    const char *device, *driver;
    /* What is left out of the formulas: ids or filters, as "blend/min", or entries such as "shape:mat4". The list ends with NULL. */
    const char *const *excludes;
    /* Where the code of formulas stands, for annotations. The list ends with an entry whose id is NULL. */
    const lightmeter_source *sources;
    /* What tells its code from other code of the same version, such as a commit; shards of another build are not merged. */
    const char *build;
} lightmeter_about;

/* Answers until standard input ends; what `main` returns. */
int lightmeter_serve(const char *name, const char *version, const lightmeter_formula *formulas, size_t count);

/* The same, with more about the renderer. */
int lightmeter_serve_as(const lightmeter_about *about, const lightmeter_formula *formulas, size_t count);

#ifdef __cplusplus
}
#endif

#endif

#ifdef LIGHTMETER_IMPLEMENTATION

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#endif

const float *lightmeter_input(const lightmeter_case *asked, const char *name, size_t count)
{
    static const float none[LIGHTMETER_NUMBERS] = {0};
    for (size_t k = 0; k < asked->input_count; ++k)
        if (strcmp(asked->inputs[k].name, name) == 0 && asked->inputs[k].count == count)
            return asked->numbers + asked->inputs[k].first;
    /* A case is the serving function's own, which looks at this after the answer. */
    snprintf(((lightmeter_case *)asked)->error, LIGHTMETER_NAME, "no input `%.100s` of %zu numbers", name, count);
    return none;
}

/* Each reader takes what begins at `at` and gives what follows, or NULL where it is not that. */
static const char *lightmeter_space(const char *at)
{
    return at ? at + strspn(at, " \t\r\n") : NULL;
}

static const char *lightmeter_sign(const char *at, char sign)
{
    at = lightmeter_space(at);
    return at && *at == sign ? at + 1 : NULL;
}

/* A string into `out`; ids and names have no escapes but that of quotes and backslashes. */
static const char *lightmeter_string(const char *at, char *out, size_t size)
{
    size_t count = 0;
    at = lightmeter_sign(at, '"');
    while (at && *at && *at != '"') {
        if (*at == '\\' && at[1])
            ++at;
        if (count + 1 < size)
            out[count++] = *at;
        ++at;
    }
    if (!at || !*at)
        return NULL;
    out[count] = '\0';
    return at + 1;
}

static const char *lightmeter_number(const char *at, float *out)
{
    char word[8];
    at = lightmeter_space(at);
    if (at && *at == '"') {
        at = lightmeter_string(at, word, sizeof word);
        if (at && strcmp(word, "NaN") == 0)
            *out = NAN;
        else if (at && strcmp(word, "Inf") == 0)
            *out = INFINITY;
        else if (at && strcmp(word, "-Inf") == 0)
            *out = -INFINITY;
        else
            return NULL;
        return at;
    }
    if (at) {
        char *end;
        *out = strtof(at, &end);
        return end == at ? NULL : end;
    }
    return NULL;
}

/* Any value, which is of no interest. */
static const char *lightmeter_skip(const char *at)
{
    char name[LIGHTMETER_NAME];
    int depth = 0;
    at = lightmeter_space(at);
    do {
        if (!at || !*at)
            return NULL;
        if (*at == '"') {
            at = lightmeter_string(at, name, sizeof name);
        } else {
            depth += (*at == '{' || *at == '[') - (*at == '}' || *at == ']');
            ++at;
        }
    } while (at && *at && (depth > 0 || (*at != ',' && *at != '}' && *at != ']')));
    return at;
}

static const char *lightmeter_inputs(const char *at, lightmeter_case *asked)
{
    at = lightmeter_sign(at, '{');
    while (at && !lightmeter_sign(at, '}')) {
        if (asked->input_count == LIGHTMETER_INPUTS)
            return NULL;
        size_t first = asked->number_count, place = asked->input_count++;
        at = lightmeter_sign(lightmeter_string(at, asked->inputs[place].name, LIGHTMETER_NAME), ':');
        const char *list = lightmeter_sign(at, '[');
        at = list ? list : at;
        do {
            if (asked->number_count == LIGHTMETER_NUMBERS)
                return NULL;
            at = lightmeter_number(at, &asked->numbers[asked->number_count++]);
        } while (list && lightmeter_sign(at, ',') && (at = lightmeter_sign(at, ',')));
        if (list)
            at = lightmeter_sign(at, ']');
        asked->inputs[place].first = first;
        asked->inputs[place].count = asked->number_count - first;
        if (at && lightmeter_sign(at, ','))
            at = lightmeter_sign(at, ',');
    }
    return lightmeter_sign(at, '}');
}

/* A batch in columns: how many cases it has, the numbers of each output, and the bytes of its arrays. The inputs stand in a case. */
typedef struct {
    unsigned long batch, count, bytes;
    size_t outputs[LIGHTMETER_OUTPUTS], output_count;
} lightmeter_columns;

/* A whole number without a sign. */
static const char *lightmeter_whole(const char *at, unsigned long *out)
{
    char *end;
    at = lightmeter_space(at);
    if (!at || *at < '0' || *at > '9')
        return NULL;
    *out = strtoul(at, &end, 10);
    return end;
}

/* `[{"name": "p", "components": 3}, …]`: of inputs, whose names a case keeps, or of outputs. */
static const char *lightmeter_arrays(const char *at, lightmeter_case *asked, lightmeter_columns *columns, int are_inputs)
{
    char field[LIGHTMETER_NAME], name[LIGHTMETER_NAME];
    at = lightmeter_sign(at, '[');
    while (at && !lightmeter_sign(at, ']')) {
        unsigned long components = 0;
        name[0] = '\0';
        at = lightmeter_sign(at, '{');
        while (at && !lightmeter_sign(at, '}')) {
            at = lightmeter_sign(lightmeter_string(at, field, sizeof field), ':');
            if (at && strcmp(field, "name") == 0)
                at = lightmeter_string(at, name, sizeof name);
            else if (at && strcmp(field, "components") == 0)
                at = lightmeter_whole(at, &components);
            else if (at)
                at = lightmeter_skip(at);
            if (at && lightmeter_sign(at, ','))
                at = lightmeter_sign(at, ',');
        }
        at = lightmeter_sign(at, '}');
        if (!at || !name[0] || components == 0 || components > LIGHTMETER_NUMBERS)
            return NULL;
        if (are_inputs) {
            if (asked->input_count == LIGHTMETER_INPUTS || asked->number_count + components > LIGHTMETER_NUMBERS)
                return NULL;
            size_t place = asked->input_count++;
            memcpy(asked->inputs[place].name, name, sizeof name);
            asked->inputs[place].first = asked->number_count;
            asked->inputs[place].count = components;
            asked->number_count += components;
        } else {
            if (columns->output_count == LIGHTMETER_OUTPUTS)
                return NULL;
            columns->outputs[columns->output_count++] = components;
        }
        if (lightmeter_sign(at, ','))
            at = lightmeter_sign(at, ',');
    }
    return lightmeter_sign(at, ']');
}

enum lightmeter_kind { LIGHTMETER_HELLO, LIGHTMETER_BATCH, LIGHTMETER_CASE, LIGHTMETER_COLUMNS, LIGHTMETER_OTHER };

static enum lightmeter_kind lightmeter_read(const char *line, lightmeter_case *asked, lightmeter_columns *columns)
{
    enum lightmeter_kind kind = LIGHTMETER_OTHER;
    char field[LIGHTMETER_NAME], word[LIGHTMETER_NAME];
    memset(asked, 0, sizeof *asked);
    memset(columns, 0, sizeof *columns);
    const char *at = lightmeter_sign(line, '{');
    while (at && !lightmeter_sign(at, '}')) {
        at = lightmeter_sign(lightmeter_string(at, field, sizeof field), ':');
        if (at && strcmp(field, "hello") == 0) {
            at = lightmeter_string(at, word, sizeof word);
            kind = at && strcmp(word, LIGHTMETER_PROTOCOL) == 0 ? LIGHTMETER_HELLO : LIGHTMETER_OTHER;
        } else if (at && strcmp(field, "columns") == 0) {
            kind = LIGHTMETER_COLUMNS;
            at = lightmeter_string(at, asked->formula, LIGHTMETER_NAME);
        } else if (at && strcmp(field, "batch") == 0) {
            kind = kind == LIGHTMETER_COLUMNS ? kind : LIGHTMETER_BATCH;
            at = lightmeter_whole(at, &columns->batch);
        } else if (at && strcmp(field, "count") == 0) {
            at = lightmeter_whole(at, &columns->count);
        } else if (at && strcmp(field, "bytes") == 0) {
            at = lightmeter_whole(at, &columns->bytes);
        } else if (at && strcmp(field, "outputs") == 0) {
            at = lightmeter_arrays(at, asked, columns, 0);
        } else if (at && strcmp(field, "inputs") == 0 && lightmeter_sign(at, '[')) {
            at = lightmeter_arrays(at, asked, columns, 1);
        } else if (at && strcmp(field, "id") == 0) {
            at = lightmeter_string(at, asked->id, LIGHTMETER_NAME);
        } else if (at && strcmp(field, "formula") == 0) {
            at = lightmeter_string(at, asked->formula, LIGHTMETER_NAME);
        } else if (at && strcmp(field, "inputs") == 0) {
            kind = LIGHTMETER_CASE;
            at = lightmeter_inputs(at, asked);
        } else if (at) {
            at = lightmeter_skip(at);
        }
        if (at && lightmeter_sign(at, ','))
            at = lightmeter_sign(at, ',');
    }
    return at ? kind : LIGHTMETER_OTHER;
}

/* A string in quotes, as JSON has it; control characters are left out. */
static void lightmeter_write(const char *text)
{
    putchar('"');
    for (; *text; ++text) {
        if (*text == '"' || *text == '\\')
            putchar('\\');
        if ((unsigned char)*text >= ' ')
            putchar(*text);
    }
    putchar('"');
}

static void lightmeter_field(const char *name, const char *text)
{
    if (text) {
        printf(", \"%s\": ", name);
        lightmeter_write(text);
    }
}

static const lightmeter_formula *lightmeter_find(const char *id, const lightmeter_formula *formulas, size_t count)
{
    for (size_t k = 0; k < count; ++k)
        if (strcmp(formulas[k].id, id) == 0 && formulas[k].outputs <= LIGHTMETER_OUTPUTS)
            return &formulas[k];
    return NULL;
}

/* Answers a batch in columns; whether its bytes could be read. A batch in which a case goes wrong is asked again by lines. */
static int lightmeter_answer_columns(lightmeter_case *asked, const lightmeter_columns *columns, const lightmeter_formula *formula)
{
    float out[LIGHTMETER_OUTPUTS];
    size_t count = columns->count, outputs = 0;
    for (size_t k = 0; k < columns->output_count; ++k)
        outputs += columns->outputs[k];
    if (asked->number_count == 0 || outputs == 0 || count > (size_t)-1 / sizeof(float) / (asked->number_count + outputs))
        return 0;
    if (columns->bytes != sizeof(float) * count * asked->number_count)
        return 0;
    float *given = (float *)malloc(columns->bytes + 1), *answers = (float *)calloc(count * outputs + 1, sizeof(float));
    int is_read = given && answers && fread(given, 1, columns->bytes, stdin) == columns->bytes;
    if (!is_read) {
        free(given);
        free(answers);
        return 0;
    }
    int is_answered = formula && formula->outputs == outputs;
    for (size_t row = 0; row < count && is_answered; ++row) {
        for (size_t k = 0; k < asked->input_count; ++k) {
            size_t first = asked->inputs[k].first, components = asked->inputs[k].count;
            memcpy(asked->numbers + first, given + count * first + row * components, components * sizeof(float));
        }
        memset(out, 0, sizeof out);
        formula->answer(asked, out);
        is_answered = !asked->error[0];
        for (size_t k = 0, first = 0; k < columns->output_count; first += columns->outputs[k++])
            memcpy(answers + count * first + row * columns->outputs[k], out + first, columns->outputs[k] * sizeof(float));
    }
    fputs("{\"columns\": ", stdout);
    lightmeter_write(asked->formula);
    printf(", \"batch\": %lu, ", columns->batch);
    if (is_answered) {
        printf("\"bytes\": %lu}\n", (unsigned long)(count * outputs * sizeof(float)));
        fwrite(answers, sizeof(float), count * outputs, stdout);
    } else {
        printf("\"lines\": true}\n");
    }
    fflush(stdout);
    free(given);
    free(answers);
    return 1;
}

static void lightmeter_answer(lightmeter_case *asked, const lightmeter_formula *formula)
{
    float out[LIGHTMETER_OUTPUTS] = {0};
    if (formula)
        formula->answer(asked, out);
    else
        snprintf(asked->error, LIGHTMETER_NAME, "no formula `%.100s` is answered", asked->formula);
    if (asked->error[0]) {
        fputs("{\"id\": ", stdout);
        lightmeter_write(asked->id);
        lightmeter_field("error", asked->error);
        puts("}");
        return;
    }
    fputs("{\"id\": ", stdout);
    lightmeter_write(asked->id);
    fputs(", \"value\": [", stdout);
    for (size_t k = 0; k < formula->outputs; ++k) {
        const char *comma = k ? ", " : "";
        if (isnan(out[k]))
            printf("%s\"NaN\"", comma);
        else if (isinf(out[k]))
            printf("%s\"%sInf\"", comma, out[k] < 0 ? "-" : "");
        else
            printf("%s%.9g", comma, out[k]);
    }
    printf("]}\n");
}

static void lightmeter_hello(const lightmeter_about *about, const lightmeter_formula *formulas, size_t count)
{
    const unsigned one = 1;
    printf("{\"hello\": \"%s\"", LIGHTMETER_PROTOCOL);
    lightmeter_field("renderer", about->name);
    lightmeter_field("version", about->version ? about->version : "");
    lightmeter_field("device", about->device);
    lightmeter_field("driver", about->driver);
    lightmeter_field("build", about->build);
    printf(", \"columns\": %s, \"excludes\": [", *(const unsigned char *)&one ? "true" : "false");
    for (size_t k = 0; about->excludes && about->excludes[k]; ++k) {
        fputs(k ? ", " : "", stdout);
        lightmeter_write(about->excludes[k]);
    }
    printf("], \"formulas\": [");
    for (size_t k = 0; k < count; ++k) {
        fputs(k ? ", " : "", stdout);
        lightmeter_write(formulas[k].id);
    }
    printf("], \"sources\": [");
    for (size_t k = 0; about->sources && about->sources[k].id; ++k) {
        const lightmeter_source *source = about->sources + k;
        fputs(k ? ", {\"id\": " : "{\"id\": ", stdout);
        lightmeter_write(source->id);
        lightmeter_field("file", source->file);
        if (source->line)
            printf(", \"line\": %u", source->line);
        putchar('}');
    }
    printf("]}\n");
    fflush(stdout);
}

int lightmeter_serve(const char *name, const char *version, const lightmeter_formula *formulas, size_t count)
{
    lightmeter_about about = {name, version, NULL, NULL, NULL, NULL, NULL};
    return lightmeter_serve_as(&about, formulas, count);
}

int lightmeter_serve_as(const lightmeter_about *about, const lightmeter_formula *formulas, size_t count)
{
    char *line = (char *)malloc(LIGHTMETER_LINE + 2);
    lightmeter_case *asked = (lightmeter_case *)malloc(sizeof *asked);
    lightmeter_columns columns;
    if (!line || !asked)
        return 1;
#ifdef _WIN32
    _setmode(_fileno(stdin), _O_BINARY);
    _setmode(_fileno(stdout), _O_BINARY);
#endif
    while (fgets(line, LIGHTMETER_LINE + 2, stdin)) {
        switch (lightmeter_read(line, asked, &columns)) {
        case LIGHTMETER_HELLO:
            lightmeter_hello(about, formulas, count);
            break;
        case LIGHTMETER_COLUMNS:
            if (!lightmeter_answer_columns(asked, &columns, lightmeter_find(asked->formula, formulas, count))) {
                fprintf(stderr, "a batch of %s cannot be read: its sizes are wrong, it ends early, or memory is short\n", asked->formula);
                free(asked);
                free(line);
                return 1;
            }
            break;
        case LIGHTMETER_BATCH:
            fflush(stdout);
            break;
        case LIGHTMETER_CASE:
            lightmeter_answer(asked, lightmeter_find(asked->formula, formulas, count));
            break;
        case LIGHTMETER_OTHER:
            if (strstr(line, "\"hello\"") && strstr(line, "lightmeter.protocol/"))
                fprintf(stderr, "the gate speaks another version than " LIGHTMETER_PROTOCOL ", which this client speaks: %.200s\n", line);
            else
                fprintf(stderr, "a line is none of " LIGHTMETER_PROTOCOL ": %.200s\n", line);
            free(asked);
            free(line);
            return 1;
        }
    }
    free(asked);
    free(line);
    return fflush(stdout) ? 1 : 0;
}

#endif
