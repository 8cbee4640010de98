// Free rods in plain JavaScript: the explicit midpoint rule in p, with p brought back to |p| = 1 after each step.
//
//     node midpoint.js REF MINE                      answers the problems about rods in MINE/NAME/answer.csv
//     shearbed grade --command "node midpoint.js"    answers requests, lines of JSON (docs/grading.md)
//
// Needs nothing but node.
"use strict";
const fs = require("fs");
const path = require("path");

function rateMatrix(L, ratio) {
  const square = ratio * ratio;
  return L.map((row, i) => row.map((value, j) => (square * value - L[j][i]) / (square + 1)));
}

function rate(A, p) {
  const Ap = A.map((row) => row[0] * p[0] + row[1] * p[1] + row[2] * p[2]);
  const along = p[0] * Ap[0] + p[1] * Ap[1] + p[2] * Ap[2];
  return Ap.map((value, i) => value - p[i] * along);
}

function advance(A, start, time, steps) {
  const h = time / steps;
  let p = start;
  for (let k = 0; k < steps; k++) {
    const half = rate(A, p).map((value, i) => p[i] + 0.5 * h * value);
    const end = rate(A, half).map((value, i) => p[i] + h * value);
    const length = Math.hypot(...end);
    p = end.map((value) => value / length);
  }
  return p;
}

function answer(request) {
  if (!request.steps) return { id: request.id, error: "it takes steps, no tolerance" };
  const A = rateMatrix(request.gradient_per_s, request.aspect_ratio);
  return { id: request.id, p: request.start.map((p) => advance(A, p, request.end_s, request.steps)) };
}

function files(reference, mine) {
  for (const name of fs.readdirSync(reference)) {
    const problem = JSON.parse(fs.readFileSync(path.join(reference, name, "problem.json")));
    if (problem.kind !== "rods") continue;
    const rows = fs.readFileSync(path.join(reference, name, "start.csv"), "utf8").trim().split("\n").slice(1);
    const start = rows.map((row) => row.split(",").slice(1).map(Number));
    const lines = ["time_s,rod,p1,p2,p3"];
    for (const time of problem.times_s) {
      const request = { ...problem, start, end_s: time, steps: 20000 };
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
