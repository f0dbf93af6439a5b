/* Three formulas in C by clients/c/lightmeter.h:
 *
 *     cc -O2 -std=c99 -ffp-contract=off -I clients/c conformance/renderers/example/renderer.c -lm -o renderer
 *     lightmeter gate --exec ./renderer fog/exp vector/reflect lighting/diffuse-toward
 */
#define LIGHTMETER_IMPLEMENTATION
#include "lightmeter.h"

static float dot(const float *a, const float *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void reflect(const lightmeter_case *asked, float *r)
{
    const float *i = lightmeter_input(asked, "i", 3), *n = lightmeter_input(asked, "n", 3);
    for (int k = 0; k < 3; ++k)
        r[k] = i[k] - 2.0f * dot(i, n) * n[k];
}

static void exponential_fog(const lightmeter_case *asked, float *out)
{
    const float *p = lightmeter_input(asked, "p", 3), *density = lightmeter_input(asked, "density", 1);
    const float *fog = lightmeter_input(asked, "fog", 3), *shaded = lightmeter_input(asked, "shaded", 3);
    float f = fminf(fmaxf(expf(-density[0] * fabsf(p[2])), 0.0f), 1.0f);
    out[0] = f;
    for (int k = 0; k < 3; ++k)
        out[1 + k] = fog[k] * (1.0f - f) + shaded[k] * f;
}

static void diffuse(const lightmeter_case *asked, float *color)
{
    const float *ld = lightmeter_input(asked, "ld", 3), *md = lightmeter_input(asked, "md", 3);
    float incidence = fmaxf(dot(lightmeter_input(asked, "l", 3), lightmeter_input(asked, "n", 3)), 0.0f);
    for (int k = 0; k < 3; ++k)
        color[k] = ld[k] * md[k] * incidence;
}

static const lightmeter_formula formulas[] = {
    {"vector/reflect", 3, reflect},
    {"fog/exp", 4, exponential_fog},
    {"lighting/diffuse-toward", 3, diffuse},
};

int main(void)
{
    static const lightmeter_source sources[] = {
        {"vector/reflect", "conformance/renderers/example/renderer.c", 14},
        {"fog/exp", "conformance/renderers/example/renderer.c", 21},
        {"lighting/diffuse-toward", "conformance/renderers/example/renderer.c", 31},
        {NULL, NULL, 0},
    };
    const lightmeter_about about = {.name = "example-c", .version = "1.0", .device = "the processor", .sources = sources};
    return lightmeter_serve_as(&about, formulas, sizeof formulas / sizeof formulas[0]);
}
