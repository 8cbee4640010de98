# A template: put your own method in place of `advance`, and have it graded.
#
#     shearbed grade --protocol text --command "julia my_code.jl"
#
# A request is one line of numbers: id, du_i/dx_j row by row, r_e, the time in s, the number of steps or 0, the tolerance or 0,
# the number of rods, and p1 p2 p3 of each. The answer is the id and p1 p2 p3 of each rod at that time, or "ID error REASON".
# See docs/src/user/grading.md.
using LinearAlgebra

function rate(A, p)
    Ap = A * p
    Ap - p * dot(p, Ap)
end

# YOUR METHOD: p after `steps` equal steps to `time`. Here: RK4 of p' = Ap - p (p.Ap), A = W + Lambda D.
function advance(L, r, time, steps, p)
    A = (r^2 * L - L') / (r^2 + 1)
    h = time / steps
    for _ in 1:steps
        k1 = rate(A, p)
        k2 = rate(A, p + h / 2 * k1)
        k3 = rate(A, p + h / 2 * k2)
        k4 = rate(A, p + h * k3)
        p += h / 6 * (k1 + 2k2 + 2k3 + k4)
    end
    p
end

for line in eachline(stdin)
    words = split(line)
    x = parse.(Float64, words[2:end])
    L, r, time, steps, rods = permutedims(reshape(x[1:9], 3, 3)), x[10], x[11], Int(x[12]), Int(x[14])
    if steps == 0
        println(words[1], " error it takes steps, no tolerance")
    else
        ends = [advance(L, r, time, steps, x[12+3n:14+3n]) for n in 1:rods]
        println(join([words[1]; string.(vcat(ends...))], " "))
    end
    flush(stdout)
end
