/* A free rod in C: classical RK4 of p' = Ap - p (p.Ap) in p, without keeping |p| = 1.
 *
 *     cc -O2 -o c_rk4 c_rk4.c -lm
 *     shearbed grade --command ./c_rk4
 *
 * Reads requests, lines of JSON as shearbed writes them, and answers each; see docs/src/user/grading.md.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_RODS = 4096, LONGEST = 1 << 20 };

static double A[3][3];

static void rate(const double p[3], double out[3])
{
    double Ap[3], along = 0;
    for (int i = 0; i < 3; i++) {
        Ap[i] = A[i][0] * p[0] + A[i][1] * p[1] + A[i][2] * p[2];
        along += p[i] * Ap[i];
    }
    for (int i = 0; i < 3; i++)
        out[i] = Ap[i] - p[i] * along;
}

static void rk4(double p[3], double h)
{
    double k1[3], k2[3], k3[3], k4[3], y[3];
    rate(p, k1);
    for (int i = 0; i < 3; i++) y[i] = p[i] + 0.5 * h * k1[i];
    rate(y, k2);
    for (int i = 0; i < 3; i++) y[i] = p[i] + 0.5 * h * k2[i];
    rate(y, k3);
    for (int i = 0; i < 3; i++) y[i] = p[i] + h * k3[i];
    rate(y, k4);
    for (int i = 0; i < 3; i++) p[i] += h / 6 * (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]);
}

/* The place after "key": in a request, or NULL. */
static const char *after(const char *line, const char *key)
{
    const char *at = strstr(line, key);
    return at ? at + strlen(key) : NULL;
}

/* The numbers from here to the bracket that closes, at most so many. */
static int numbers(const char *at, double *into, int most)
{
    int count = 0, depth = 0;
    while (at && *at) {
        if (*at == '[') { depth++; at++; }
        else if (*at == ']') { if (--depth == 0) break; at++; }
        else if (*at == ',' || *at == ' ') at++;
        else {
            char *end;
            double value = strtod(at, &end);
            if (end == at || count == most) return -1;
            into[count++] = value;
            at = end;
        }
    }
    return count;
}

int main(void)
{
    static char line[LONGEST];
    static double start[3 * MOST_RODS];
    while (fgets(line, sizeof line, stdin)) {
        const char *id = after(line, "\"id\":"), *steps_at = after(line, "\"steps\":");
        const char *ratio = after(line, "\"aspect_ratio\":"), *end = after(line, "\"end_s\":");
        double L[9];
        int rods = numbers(after(line, "\"start\":"), start, 3 * MOST_RODS) / 3;
        long number = id ? atol(id) : 0;
        if (!steps_at || !ratio || !end || rods < 1 || numbers(after(line, "\"gradient_per_s\":"), L, 9) != 9) {
            printf("{\"id\": %ld, \"error\": \"it takes steps, and a gradient, an aspect ratio, starts and an end\"}\n", number);
            fflush(stdout);
            continue;
        }
        double square = atof(ratio) * atof(ratio);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                A[i][j] = (square * L[3 * i + j] - L[3 * j + i]) / (square + 1);
        long long steps = atoll(steps_at);
        double h = atof(end) / (double)steps;
        printf("{\"id\": %ld, \"p\": [", number);
        for (int rod = 0; rod < rods; rod++) {
            double *p = start + 3 * rod;
            for (long long k = 0; k < steps; k++)
                rk4(p, h);
            printf("%s[%.17g, %.17g, %.17g]", rod ? ", " : "", p[0], p[1], p[2]);
        }
        printf("]}\n");
        fflush(stdout);
    }
    return 0;
}
