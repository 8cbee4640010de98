// A template: put your own method in place of `advance`, compile, and have it graded.
//
//     c++ -O2 -o my_code my_code.cpp
//     shearbed grade --protocol text --command ./my_code
//
// A request is one line of numbers: id, du_i/dx_j row by row, r_e, the time in s, the number of steps or 0, the tolerance or 0,
// the number of rods, and p1 p2 p3 of each. The answer is the id and p1 p2 p3 of each rod at that time, or "ID error REASON".
// See docs/src/user/grading.md.
#include <array>
#include <iomanip>
#include <iostream>

using Vector = std::array<double, 3>;
using Matrix = std::array<Vector, 3>;

Vector plus(const Vector &a, double f, const Vector &b) { return {a[0] + f * b[0], a[1] + f * b[1], a[2] + f * b[2]}; }
double dot(const Vector &a, const Vector &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector rate(const Matrix &A, const Vector &p) {
  const Vector Ap{dot(A[0], p), dot(A[1], p), dot(A[2], p)};
  return plus(Ap, -dot(p, Ap), p);
}

// YOUR METHOD: p after `steps` equal steps to `time`. Here: RK4 of p' = Ap - p (p.Ap), A = W + Lambda D.
Vector advance(const Matrix &L, double r, double time, long steps, Vector p) {
  Matrix A;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) A[i][j] = (r * r * L[i][j] - L[j][i]) / (r * r + 1);
  const double h = time / steps;
  for (long n = 0; n < steps; n++) {
    const Vector k1 = rate(A, p), k2 = rate(A, plus(p, h / 2, k1)), k3 = rate(A, plus(p, h / 2, k2)), k4 = rate(A, plus(p, h, k3));
    for (int i = 0; i < 3; i++) p[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  }
  return p;
}

int main() {
  long id, steps, rods;
  double r, time, tolerance;
  Matrix L;
  std::cout << std::setprecision(17);
  while (std::cin >> id) {
    for (auto &row : L)
      for (auto &value : row) std::cin >> value;
    std::cin >> r >> time >> steps >> tolerance >> rods;
    std::cout << id << (steps == 0 ? " error it takes steps, no tolerance" : "");
    for (long n = 0; n < rods; n++) {
      Vector p;
      std::cin >> p[0] >> p[1] >> p[2];
      if (steps == 0) continue;
      p = advance(L, r, time, steps, p);
      std::cout << ' ' << p[0] << ' ' << p[1] << ' ' << p[2];
    }
    std::cout << std::endl;  // writes it out at once
  }
}
