"""Numbers as text, and with the key by which check_numbers.py finds and recomputes them."""
import math


def sig(value, digits=3):
    """A number with so many significant digits, without an exponent where it stays readable."""
    if value == 0:
        return "0"
    if abs(value) < 1e-4 or abs(value) >= 1e6:
        base, exponent = f"{value:.{digits - 1}e}".split("e")
        return f"{base} · 10<sup>{int(exponent)}</sup>".replace("-", "−")
    rounded = float(f"{value:.{digits - 1}e}")
    places = max(0, digits - 1 - math.floor(math.log10(abs(rounded))))
    return f"{rounded:,.{places}f}".replace(",", "\u00a0").replace("-", "−")


def times(ratio):
    """"3.2 times"."""
    return f"{sig(ratio, 2)} times"


def keyed(key, value, digits=3):
    """A number that check_numbers.py recomputes."""
    return f'<data data-key="{key}" value="{value!r}">{sig(value, digits)}</data>'


def count(key, value):
    return f'<data data-key="{key}" value="{value}">{value}</data>'


def interval(key, estimate, digits=2):
    """"[1.6, 2.0]"."""
    return (f'<span class="interval">[{keyed(key + "/low", estimate.low, digits)}, '
            f'{keyed(key + "/high", estimate.high, digits)}]</span>')


def with_interval(key, estimate, digits=2):
    """"1.8 [1.6, 2.0]"."""
    return f"{keyed(key, estimate.value, digits)} {interval(key, estimate, digits)}"


def bare_interval(estimate, digits=2):
    """The same as text alone."""
    return f'<span class="interval">[{sig(estimate.low, digits)}, {sig(estimate.high, digits)}]</span>'
