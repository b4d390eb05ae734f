#!/usr/bin/env python3
"""Prints math_coefficients.h: polynomials for the transcendental functions of every tier.

Each polynomial minimises the greatest relative error of the function it serves (Remez's exchange algorithm, see Trefethen,
"Approximation Theory and Approximation Practice", ch. 10). Values come from series with 60-digit decimals, the linear
systems are solved in decimals too, and coefficients are printed as hexadecimal floats: nothing depends on the machine's
math library.
"""
from decimal import Decimal as D, getcontext
from functools import cache

getcontext().prec = 60
PI = D("3.14159265358979323846264338327950288419716939937510582097494459")
LN2 = D("0.693147180559945309417232121458176568075500134360255254120680009")


def power_series(coefficient, z):
    total, power, k = D(0), D(1), 0
    while k < 400 and abs(power) > D(10) ** -58:
        total += coefficient(k) * power
        power *= z
        k += 1
    return total


@cache
def factorial(n):
    result = D(1)
    for k in range(2, n + 1):
        result *= k
    return result


@cache
def central(k):
    """(2k)! / (4^k k!^2 (2k + 1)): the coefficients of asin."""
    return factorial(2 * k) / (D(4) ** k * factorial(k) ** 2 * (2 * k + 1))


def sine(r):
    return power_series(lambda k: D(-1) ** k / factorial(2 * k + 1), r * r) * r


def cosine(r):
    return power_series(lambda k: D(-1) ** k / factorial(2 * k), r * r)


def tangent(z):
    """(tan r - r) / r^3 for r^2 = z."""
    r = z.sqrt()
    return (sine(r) / cosine(r) - r) / (r * z)


# What a mantissa in [sqrt(1/2), sqrt(2)) exceeds 1 by.
MANTISSA = (D("0.5").sqrt() - 1, D(2).sqrt() - 1)

# The functions to approximate, in the argument of the polynomial; the weight that makes their errors relative errors of the
# whole (where that does not vanish inside the interval, which Remez's algorithm forbids); their intervals.
FUNCTIONS = {
    # (2^f - 1) / f
    "exp2": (lambda f: power_series(lambda k: LN2 ** (k + 1) / factorial(k + 1), f), lambda f: 1 / (f * LN2).exp(),
             D("-0.5"), D("0.5")),
    # (e^r - 1) / r
    "exp": (lambda r: power_series(lambda k: 1 / factorial(k + 1), r), lambda r: 1 / r.exp(), -LN2 / 2, LN2 / 2),
    # (sin r - r) / r^3 in z = r^2, |r| <= pi / 2 + 0.04: far angles are not reduced exactly to the nearest multiple
    "sine": (lambda z: power_series(lambda k: D(-1) ** (k + 1) / factorial(2 * k + 3), z),
             lambda z: z * z.sqrt() / sine(z.sqrt()), D(0), (PI / 2 + D("0.04")) ** 2),
    # (tan r - r) / r^3 in z = r^2, |r| <= pi / 4 + 0.02
    "tangent": (tangent, lambda z: z / (1 + z * tangent(z)), D(0), (PI / 4 + D("0.02")) ** 2),
    # log2(1 + t) / t
    "log2": (lambda t: (1 + t).ln() / LN2 / t, lambda t: t / (1 + t).ln() * LN2, *MANTISSA),
    # (log(1 + t) - t) / t^2
    "log": (lambda t: ((1 + t).ln() - t) / (t * t), lambda t: 1, *MANTISSA),
    # (atanh s - s) / s^3 in z = s^2, s = (m - 1) / (m + 1), m in [sqrt(1/2), sqrt(2)]
    "logarithm": (lambda z: power_series(lambda k: D(1) / (2 * k + 3), z), lambda z: z, D(0), D("0.02943725152285942")),
    # (atan t - t) / t^3 in z = t^2, |t| <= tan(pi / 8)
    "arctangent": (lambda z: power_series(lambda k: D(-1) ** (k + 1) / (2 * k + 3), z), lambda z: z, D(0),
                   D("0.17157287525381")),
    # (asin x - x) / x^3 in z = x^2, |x| <= 1/2
    "arcsine": (lambda z: power_series(lambda k: central(k + 1), z), lambda z: z, D(0), D("0.25")),
    # (sinh x - x) / x^3 in z = x^2, |x| <= 1
    "hyperbolicSine": (lambda z: power_series(lambda k: 1 / factorial(2 * k + 3), z), lambda z: z, D(0), D(1)),
}

# Coefficients by tier; 0 = the tier does not use the polynomial. The tiers in float take the logarithm without a
# division, those in double the shorter series with one.
TIERS = ("fast", "standard", "fine", "reference")
DOUBLE = ("fine", "reference")
COUNTS = {
    "exp2": (3, 6, 7, 12), "exp": (3, 6, 7, 11), "sine": (2, 4, 5, 9), "tangent": (3, 6, 8, 14), "log2": (5, 9, 0, 0),
    "log": (4, 8, 0, 0), "logarithm": (0, 0, 4, 8), "arctangent": (2, 4, 6, 11), "arcsine": (2, 5, 8, 14),
    "hyperbolicSine": (2, 4, 5, 9),
}


def grid(low, high, count):
    """`count` points, denser towards the ends; neither 0 nor an end."""
    points = []
    for k in range(count):
        points.append((low + high) / 2 - (high - low) / 2 * cosine(PI * (2 * k + 1) / (2 * count)))
    return points


def solve(rows):
    """Gauss-Jordan elimination of rows [a1 .. an b]."""
    n = len(rows)
    for column in range(n):
        pivot = max(range(column, n), key=lambda row: abs(rows[row][column]))
        rows[column], rows[pivot] = rows[pivot], rows[column]
        for row in range(n):
            if row == column:
                continue
            factor = rows[row][column] / rows[column][column]
            rows[row] = [x - factor * y for x, y in zip(rows[row], rows[column])]
    return [rows[k][n] / rows[k][k] for k in range(n)]


def value(coefficients, x):
    total = D(0)
    for c in reversed(coefficients):
        total = total * x + c
    return total


def best(points, values, weights, count):
    """The `count` coefficients, constant first, with the least greatest weighted error on the points."""
    last = len(points) - 1
    chosen = [round(last * (1 - float(cosine(PI * k / count))) / 2) for k in range(count + 1)]
    for _ in range(30):
        rows = [[points[i] ** k for k in range(count)] + [D(-1) ** n / weights[i], values[i]]
                for n, i in enumerate(chosen)]
        solution = solve(rows)
        coefficients, level = solution[:count], abs(solution[count])
        errors = [(value(coefficients, x) - y) * w for x, y, w in zip(points, values, weights)]
        # The greatest error of every stretch with one sign.
        extrema = []
        for i, error in enumerate(errors):
            if not extrema or (error > 0) != (errors[extrema[-1]] > 0):
                extrema.append(i)
            elif abs(error) > abs(errors[extrema[-1]]):
                extrema[-1] = i
        while len(extrema) > count + 1:
            extrema.pop(0 if abs(errors[extrema[0]]) < abs(errors[extrema[-1]]) else -1)
        if len(extrema) < count + 1 or max(map(abs, errors)) <= level * D("1.0001"):
            break
        chosen = extrema
    return coefficients


def rounded(value, bits):
    """The nearest float with `bits` bits of mantissa."""
    if value == 0:
        return 0.0
    exponent = 0
    magnitude = abs(value)
    while magnitude >= 2 ** bits:
        magnitude /= 2
        exponent += 1
    while magnitude < 2 ** (bits - 1):
        magnitude *= 2
        exponent -= 1
    return (1 if value > 0 else -1) * float(round(magnitude)) * 2.0 ** exponent


def main():
    print("// Made by math_coefficients.py; see there for the functions and the method. Coefficients, constant first.")
    print("#pragma once\n")
    print("namespace vernier::batch::coefficients {\n")
    sampled = {}
    for function, (f, weight, low, high) in FUNCTIONS.items():
        points = grid(low, high, 200)
        sampled[function] = points, [f(x) for x in points], [weight(x) for x in points]
    for tier, name in enumerate(TIERS):
        number, bits, suffix = ("double", 53, "") if name in DOUBLE else ("float", 24, "f")
        print(f"struct {name.capitalize()} {{")
        for function, samples in sampled.items():
            if COUNTS[function][tier] == 0:
                continue
            text = ", ".join(rounded(c, bits).hex() + suffix for c in best(*samples, COUNTS[function][tier]))
            print(f"    static constexpr {number} {function}[] = {{{text}}};")
        print("};\n")
    print("}  // namespace vernier::batch::coefficients")


main()
