# What several pages use: bash reads it before each command (BASH_ENV).

# The checksums of all files below this folder.
sums() { find . -type f -exec cksum {} + | sort; }

# Runs a command that must end with 2 and leave every file as it was.
refuses() {
    local before code=0
    before=$(sums)
    shearbed "$@" || code=$?
    [ $code = 2 ] || echo "EXIT CODE $code"
    [ "$before" = "$(sums)" ] || echo 'FILES HAVE CHANGED'
    return $code
}

# Copies problems of the export `ref` into a folder.
some() { mkdir -p "$1"; for name in "${@:2}"; do cp -r "ref/$name" "$1"; done; }

# The texts of a picture.
texts() { sed -n '/^<text/,/<\/text>/{/^<text/!{/<\/text>/!p}}' "$1"; }

# The CRC-32 of a file, as records have it.
crc32() { gzip -c "$1" | tail -c8 | head -c4 | od -An -tx4 | tr -d ' '; }

# Writes a file and the folders above it.
put() { mkdir -p "$(dirname "$1")"; cat > "$1"; }

# The certified rows of a problem in `ref`, each with an error of so many tolerances in the problem's own metric.
off() {
    local key='s/^  "%s": "*\([^"]*\)"*,$/\1/p'
    awk -F, -v OFS=, -v CONVFMT=%.17g -v part="$2" -v metric="$(sed -n "${key/\%s/metric}" "ref/$1/problem.json")" \
        -v tolerance="$(sed -n "${key/\%s/tolerance}" "ref/$1/problem.json")" '
        NR == 1 { for (k = NF; k > 0; k--) if ($k ~ /^a_/) { of_a[k]; first = k } }
        NR > 1 { off = part * tolerance }
        NR > 1 && metric == "angle" {
            # Turned by the angle towards the axis that is farthest off.
            axis = 3
            for (k = 4; k <= 5; k++) if ($k * $k < $axis * $axis) axis = k
            along = $axis + 0
            for (k = 3; k <= 5; k++) p[k] = $k + 0
            for (k = 3; k <= 5; k++) $k = p[k] * cos(off) + ((k == axis) - along * p[k]) / sqrt(1 - along * along) * sin(off)
        }
        NR > 1 && metric == "absolute" { $2 += off }
        NR > 1 && metric == "relative" { sum = 0; for (k in of_a) sum += $k * $k; $first += off * sqrt(sum) }
        NR > 1 && metric == "standard-errors" { $2 += off * $3 * sqrt(2) }
        { print }' "ref/$1/certified.csv"
}

# Grades the answers in a folder against those problems in `ref` that it answers; the files are in `out`.
grades() { rm -rf asked out; some asked $(ls "$1"); shearbed grade asked "$1" --out out "${@:2}"; }

# Some keys of each problem in out/grade.json.
keys() {
    sed -n '/^  "problems"/,/^  ]/p' out/grade.json | awk -v keys="$*" 'BEGIN { split(keys, key, " ") }
        match($0, /^      "[a-z_0-9]*": /) { name = substr($0, 8, RLENGTH - 10); of[name] = substr($0, RLENGTH + 1); sub(/,$/, "", of[name]) }
        /^    }/ { line = ""; for (k = 1; k in key; k++) line = line (k > 1 ? " " : "") of[key[k]]; print line; delete of }'
}

# Points of the mean curve of small.toml with a key, another seed than a fit's, with noise of 0.01 that is fixed: each
# point is off by a Gaussian quantile, in an order without a pattern.
points() {
    shearbed run small.toml --set "$1" --set time.outputs_per_period=20 --seed 7 --replicas 400 --quiet --out truth --force
    awk -F, -v OFMT=%.17g 'BEGIN { n = split("-1.6 -1.1 -0.8 -0.6 -0.5 -0.3 -0.2 -0.1 0.1 0.2 0.3 0.5 0.6 0.8 1.1 1.6 0.0 0.4 -0.4 0.7", off, " ") }
        NR == 1 { print "t_over_T,x1,x1_u" }
        NR > 2 { print $1 "," sprintf("%.17g", $4 + 0.01 * off[(7 * (NR - 3) + 3) % n + 1]) ",0.01" }' truth/projections.csv
}

# A number of a parameter, such as its estimate, in the record of a fit.
of_fit() { sed -n "/\"parameters\"/,/^  }/{/\"$2\": {/,/}/s/^ *\"$3\": \([^,]*\),*/\1/p}" "$1/fit.json"; }

# Plans a scene with each table of rods that is a line of the input.
told() { while IFS= read -r text; do printf -- "$text" > start.csv; shearbed plan "$@"; done; }

# Checks measured points, with what the input says of them.
measured() {
    cat > data/okagawa-mason-1973/a.toml; printf -- "$1" > data/okagawa-mason-1973/a.csv
    shearbed validate --case jeffery-period --data data --out x --quiet --force
}
