// Free rods in plain JavaScript: the explicit midpoint rule in p, with p brought back to |p| = 1 after each step.
//
//     node midpoint.js REF MINE                      answers the problems about rods in MINE/NAME/answer.csv
//     shearbed grade --command "node midpoint.js"    answers requests, lines of JSON (docs/src/user/grading.md)
//
// Needs nothing but node.
"use strict";
const fs = require("fs");
const path = require("path");

function rateMatrix(L, ratio) {
  const square = ratio * ratio;
  return L.map((row, i) => row.map((value, j) => (square * value - L[j][i]) / (square + 1)));
}

function rate(A, x, y, z) {
  const a = A[0][0] * x + A[0][1] * y + A[0][2] * z;
  const b = A[1][0] * x + A[1][1] * y + A[1][2] * z;
  const c = A[2][0] * x + A[2][1] * y + A[2][2] * z;
  const along = x * a + y * b + z * c;
  return [a - x * along, b - y * along, c - z * along];
}

function advance(A, start, time, steps) {
  const h = time / steps;
  let [x, y, z] = start;
  for (let k = 0; k < steps; k++) {
    const [a, b, c] = rate(A, x, y, z);
    const [d, e, f] = rate(A, x + 0.5 * h * a, y + 0.5 * h * b, z + 0.5 * h * c);
    [x, y, z] = [x + h * d, y + h * e, z + h * f];
    const length = Math.sqrt(x * x + y * y + z * z);
    [x, y, z] = [x / length, y / length, z / length];
  }
  return [x, y, z];
}

function answer(request) {
  if (!request.steps) return { id: request.id, error: "it takes steps, no tolerance" };
  if (request.rotation_rad_per_s) return { id: request.id, error: "it takes a steady flow" };
  const A = rateMatrix(request.gradient_per_s, request.aspect_ratio);
  return { id: request.id, p: request.start.map((p) => advance(A, p, request.end_s, request.steps)) };
}

function files(reference, mine) {
  for (const name of fs.readdirSync(reference)) {
    const problem = JSON.parse(fs.readFileSync(path.join(reference, name, "problem.json")));
    if (problem.kind !== "rods" || problem.rotation_rad_per_s) continue;
    const rows = fs.readFileSync(path.join(reference, name, "start.csv"), "utf8").trim().split("\n").slice(1);
    const start = rows.map((row) => row.split(",").slice(1).map(Number));
    const lines = ["time_s,rod,p1,p2,p3"];
    for (const time of problem.times_s) {
      const request = { ...problem, start, end_s: time, steps: 5000 };
      answer(request).p.forEach((p, rod) => lines.push([time, rod, ...p].join(",")));
    }
    fs.mkdirSync(path.join(mine, name), { recursive: true });
    fs.writeFileSync(path.join(mine, name, "answer.csv"), lines.join("\n") + "\n");
  }
}

if (process.argv.length > 3) {
  files(process.argv[2], process.argv[3]);
} else {
  require("readline")
    .createInterface({ input: process.stdin })
    .on("line", (line) => console.log(JSON.stringify(answer(JSON.parse(line)))));
}
