#!/usr/bin/env python3
"""Prints math_coefficients.h: polynomials for the transcendental functions of every tier.

Each polynomial interpolates its function at the Chebyshev nodes of the interval it is used on, which is within a small
factor of the best approximation (Trefethen, "Approximation Theory and Approximation Practice", ch. 4 and 15). Node values
come from series with 60-digit decimals, the interpolation is solved in exact rationals, and coefficients are printed as
hexadecimal floats: nothing depends on the machine's math library.
"""
from decimal import Decimal as D, getcontext
from fractions import Fraction as Q

getcontext().prec = 60
PI = D("3.14159265358979323846264338327950288419716939937510582097494459")
LN2 = D("0.693147180559945309417232121458176568075500134360255254120680009")


def series(first, step):
    """Sums terms until they vanish; step(k, term) is the term after term k."""
    total, term, k = D(0), first, 0
    while term != 0 and abs(term) > D(10) ** -58:
        total += term
        term = step(k, term)
        k += 1
    return total


def power_series(coefficient, z):
    total, power, k = D(0), D(1), 0
    while k < 400 and abs(power) > D(10) ** -58:
        total += coefficient(k) * power
        power *= z
        k += 1
    return total


def factorial(n):
    result = D(1)
    for k in range(2, n + 1):
        result *= k
    return result


def central(k):
    """(2k)! / (4^k k!^2 (2k + 1)): the coefficients of asin."""
    return factorial(2 * k) / (D(4) ** k * factorial(k) ** 2 * (2 * k + 1))


# The functions to approximate, as power series in the argument of the polynomial.
FUNCTIONS = {
    # (2^f - 1) / f
    "exp2": (lambda f: power_series(lambda k: LN2 ** (k + 1) / factorial(k + 1), f), D("-0.5"), D("0.5")),
    # (e^r - 1 - r) / r^2
    "exp": (lambda r: power_series(lambda k: 1 / factorial(k + 2), r), -LN2 / 2, LN2 / 2),
    # (sin r - r) / r^3 and (cos r - 1 + r^2 / 2) / r^4 in z = r^2
    "sine": (lambda z: power_series(lambda k: D(-1) ** (k + 1) / factorial(2 * k + 3), z), D(0), (PI / 4) ** 2),
    "cosine": (lambda z: power_series(lambda k: D(-1) ** k / factorial(2 * k + 4), z), D(0), (PI / 4) ** 2),
    # (atanh s - s) / s^3 in z = s^2, s = (m - 1) / (m + 1), m in [sqrt(1/2), sqrt(2)]
    "logarithm": (lambda z: power_series(lambda k: D(1) / (2 * k + 3), z), D(0), D("0.02943725152285942")),
    # (atan t - t) / t^3 in z = t^2, |t| <= tan(pi / 8)
    "arctangent": (lambda z: power_series(lambda k: D(-1) ** (k + 1) / (2 * k + 3), z), D(0), D("0.17157287525381")),
    # (asin x - x) / x^3 in z = x^2, |x| <= 1/2
    "arcsine": (lambda z: power_series(lambda k: central(k + 1), z), D(0), D("0.25")),
    # (sinh x - x) / x^3 in z = x^2, |x| <= 1
    "hyperbolicSine": (lambda z: power_series(lambda k: 1 / factorial(2 * k + 3), z), D(0), D(1)),
}

# Coefficients by tier.
COUNTS = {
    "exp2": (4, 6, 11), "exp": (3, 5, 10), "sine": (2, 3, 7), "cosine": (2, 3, 7), "logarithm": (1, 3, 7),
    "arctangent": (2, 4, 10), "arcsine": (2, 5, 13), "hyperbolicSine": (2, 4, 8),
}
TIERS = ("fast", "standard", "fine")


def chebyshev_nodes(low, high, count):
    nodes = []
    for k in range(count):
        angle = PI * (2 * k + 1) / (2 * count)
        cosine = power_series(lambda j: D(-1) ** j / factorial(2 * j), angle ** 2)
        nodes.append((low + high) / 2 + (high - low) / 2 * cosine)
    return nodes


def interpolate(xs, ys):
    """Coefficients, constant first, by Newton's divided differences in exact arithmetic."""
    xs, table = [Q(x) for x in xs], [Q(y) for y in ys]
    for level in range(1, len(xs)):
        for k in range(len(xs) - 1, level - 1, -1):
            table[k] = (table[k] - table[k - 1]) / (xs[k] - xs[k - level])
    result = [Q(0)]
    for x, c in zip(reversed(xs), reversed(table)):
        shifted = [Q(0)] + result
        for k, value in enumerate(result):
            shifted[k] -= value * x
        shifted[0] += c
        result = shifted
    return result[:len(xs)]


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
    for tier, name in enumerate(TIERS):
        number, bits, suffix = ("double", 53, "") if name == "fine" else ("float", 24, "f")
        print(f"struct {name.capitalize()} {{")
        for function, (f, low, high) in FUNCTIONS.items():
            xs = chebyshev_nodes(low, high, COUNTS[function][tier])
            values = interpolate(xs, [f(x) for x in xs])
            text = ", ".join(rounded(v, bits).hex() + suffix for v in values)
            print(f"    static constexpr {number} {function}[] = {{{text}}};")
        print("};\n")
    print("}  // namespace vernier::batch::coefficients")


main()
