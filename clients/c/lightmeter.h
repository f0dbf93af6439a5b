/* A renderer's side of lightmeter.protocol/1 in one file of C99, without dependencies. In one source file:
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
 * which an answer has one after the other. Scenes, blend units and special values are asked in the same lines (docs/protocol.md); this
 * file answers formulas.
 */
#ifndef LIGHTMETER_H
#define LIGHTMETER_H

#include <stddef.h>

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

/* Answers until standard input ends; what `main` returns. */
int lightmeter_serve(const char *name, const char *version, const lightmeter_formula *formulas, size_t count);

#endif

#ifdef LIGHTMETER_IMPLEMENTATION

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const float *lightmeter_input(const lightmeter_case *asked, const char *name, size_t count)
{
    static const float none[LIGHTMETER_NUMBERS];
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

enum lightmeter_kind { LIGHTMETER_HELLO, LIGHTMETER_BATCH, LIGHTMETER_CASE, LIGHTMETER_OTHER };

static enum lightmeter_kind lightmeter_read(const char *line, lightmeter_case *asked)
{
    enum lightmeter_kind kind = LIGHTMETER_OTHER;
    char field[LIGHTMETER_NAME], word[LIGHTMETER_NAME];
    memset(asked, 0, sizeof *asked);
    const char *at = lightmeter_sign(line, '{');
    while (at && !lightmeter_sign(at, '}')) {
        at = lightmeter_sign(lightmeter_string(at, field, sizeof field), ':');
        if (at && strcmp(field, "hello") == 0) {
            at = lightmeter_string(at, word, sizeof word);
            kind = at && strcmp(word, LIGHTMETER_PROTOCOL) == 0 ? LIGHTMETER_HELLO : LIGHTMETER_OTHER;
        } else if (at && strcmp(field, "batch") == 0) {
            kind = LIGHTMETER_BATCH;
            at = lightmeter_skip(at);
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

static void lightmeter_answer(lightmeter_case *asked, const lightmeter_formula *formulas, size_t count)
{
    float out[LIGHTMETER_OUTPUTS] = {0};
    const lightmeter_formula *formula = NULL;
    for (size_t k = 0; k < count; ++k)
        if (strcmp(formulas[k].id, asked->formula) == 0 && formulas[k].outputs <= LIGHTMETER_OUTPUTS)
            formula = &formulas[k];
    if (formula)
        formula->answer(asked, out);
    else
        snprintf(asked->error, LIGHTMETER_NAME, "no formula `%.100s` is answered", asked->formula);
    if (asked->error[0]) {
        printf("{\"id\": \"%s\", \"error\": \"%s\"}\n", asked->id, asked->error);
        return;
    }
    printf("{\"id\": \"%s\", \"value\": [", asked->id);
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

int lightmeter_serve(const char *name, const char *version, const lightmeter_formula *formulas, size_t count)
{
    char *line = malloc(LIGHTMETER_LINE + 2);
    lightmeter_case *asked = malloc(sizeof *asked);
    if (!line || !asked)
        return 1;
    while (fgets(line, LIGHTMETER_LINE + 2, stdin)) {
        switch (lightmeter_read(line, asked)) {
        case LIGHTMETER_HELLO:
            printf("{\"hello\": \"%s\", \"renderer\": \"%s\", \"version\": \"%s\", \"formulas\": [", LIGHTMETER_PROTOCOL, name, version);
            for (size_t k = 0; k < count; ++k)
                printf("%s\"%s\"", k ? ", " : "", formulas[k].id);
            printf("]}\n");
            fflush(stdout);
            break;
        case LIGHTMETER_BATCH:
            fflush(stdout);
            break;
        case LIGHTMETER_CASE:
            lightmeter_answer(asked, formulas, count);
            break;
        case LIGHTMETER_OTHER:
            fprintf(stderr, "a line is none of " LIGHTMETER_PROTOCOL ": %.200s\n", line);
            return 1;
        }
    }
    free(asked);
    free(line);
    return fflush(stdout) ? 1 : 0;
}

#endif
