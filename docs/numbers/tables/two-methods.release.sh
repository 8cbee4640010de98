# Every certified number by two methods, from the evidence of the case two-methods.
shearbed validate --case two-methods --full --out v >log
python3 - <<'P'
import json

for one in json.load(open("v/report.json"))["cases"][0]["evidence"]:
    number, methods = one["what"].split(": ", 1)
    first, second = methods.split(", and ", 1)
    claimed, shared = one["because"].split("; ", 1)
    mantissa, exponent = f"{one['error']:.0e}".split("e")
    digits = str(int(exponent)).replace("-", "⁻").translate(str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹"))
    print(f"| {number} | {first} | {second} | {mantissa}·10{digits} | {claimed} | {shared} |")
P
