/* A template: put your own method in place of `advance`, compile, and have it graded.
 *
 *     cc -O2 -o my_code my_code.c -lm
 *     shearbed grade --protocol text --command ./my_code
 *
 * A request is one line of numbers: id, du_i/dx_j row by row, r_e, the time in s, the number of steps or 0, the tolerance or 0,
 * the number of rods, and p1 p2 p3 of each. The answer is the id and p1 p2 p3 of each rod at that time, or
 * "ID error REASON". See docs/src/user/grading.md.
 */
#include <math.h>
#include <stdio.h>

static void rate(double A[3][3], const double p[3], double out[3])
{
    double Ap[3], along = 0;
    for (int i = 0; i < 3; i++) {
        Ap[i] = A[i][0] * p[0] + A[i][1] * p[1] + A[i][2] * p[2];
        along += p[i] * Ap[i];
    }
    for (int i = 0; i < 3; i++) out[i] = Ap[i] - p[i] * along;
}

/* YOUR METHOD: p after `steps` equal steps to `time`. Here: RK4 of p' = Ap - p (p.Ap), A = W + Lambda D. */
static void advance(double L[3][3], double r, double time, long steps, double p[3])
{
    double A[3][3], k[4][3], y[3], h = time / steps;
    const double part[3] = {0.5, 0.5, 1.0};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) A[i][j] = (r * r * L[i][j] - L[j][i]) / (r * r + 1);
    for (long n = 0; n < steps; n++) {
        rate(A, p, k[0]);
        for (int s = 0; s < 3; s++) {
            for (int i = 0; i < 3; i++) y[i] = p[i] + part[s] * h * k[s][i];
            rate(A, y, k[s + 1]);
        }
        for (int i = 0; i < 3; i++) p[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
    }
}

int main(void)
{
    long id, steps, rods;
    double L[3][3], r, time, tolerance, p[3];
    while (scanf("%ld", &id) == 1) {
        for (int i = 0; i < 9; i++)
            if (scanf("%lf", &L[i / 3][i % 3]) != 1) return 1;
        if (scanf("%lf %lf %ld %lf %ld", &r, &time, &steps, &tolerance, &rods) != 5) return 1;
        printf("%ld", id);
        if (steps == 0) printf(" error it takes steps, no tolerance");
        for (long n = 0; n < rods; n++) {
            if (scanf("%lf %lf %lf", &p[0], &p[1], &p[2]) != 3) return 1;
            if (steps == 0) continue;
            advance(L, r, time, steps, p);
            printf(" %.17g %.17g %.17g", p[0], p[1], p[2]);
        }
        printf("\n");
        fflush(stdout);
    }
    return 0;
}
