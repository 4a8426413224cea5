"""Figures from independent seeds, with their 95 % intervals."""
import math
import statistics
from dataclasses import dataclass

# 97.5 % quantiles of Student's t by degrees of freedom
STUDENT = {1: 12.706, 2: 4.303, 3: 3.182, 4: 2.776, 5: 2.571, 6: 2.447, 7: 2.365, 8: 2.306, 9: 2.262}


@dataclass(frozen=True)
class Estimate:
    """A positive figure; `log_error` is the standard error of its logarithm, so that its interval is positive too."""
    value: float
    log_error: float
    degrees: int

    @property
    def low(self):
        return self.value * math.exp(-STUDENT[self.degrees] * self.log_error)

    @property
    def high(self):
        return self.value * math.exp(STUDENT[self.degrees] * self.log_error)

    def over(self, other):
        """The ratio to another figure from other seeds; with the fewer degrees of freedom, to be on the safe side."""
        return Estimate(self.value / other.value, math.hypot(self.log_error, other.log_error),
                        min(self.degrees, other.degrees))

    def times(self, other):
        return Estimate(self.value * other.value, math.hypot(self.log_error, other.log_error),
                        min(self.degrees, other.degrees))

    @property
    def compared(self):
        """As a ratio of variances: "better" or "worse" where its interval leaves out 1, else "equal"."""
        return "better" if self.high < 1 else "worse" if self.low > 1 else "equal"

    @property
    def within(self):
        """How far from 1 a ratio may be, as the interval says."""
        return max(self.high, 1 / self.low) - 1


def mean_of(values):
    """The mean of one value a seed."""
    mean = statistics.fmean(values)
    return Estimate(mean, statistics.stdev(values) / math.sqrt(len(values)) / mean, len(values) - 1)


def jackknife(value, left_out):
    """A figure of all seeds, from the same figure with each seed left out in turn: Tukey's jackknife, of logarithms."""
    n = len(left_out)
    if value <= 0 or min(left_out) <= 0:
        return Estimate(value, 0.0, n - 1)
    logs = [math.log(v) for v in left_out]
    return Estimate(value, math.sqrt((n - 1) / n * sum((x - statistics.fmean(logs)) ** 2 for x in logs)), n - 1)


def slope(x, y):
    """Slope of the straight line through points, and half of its 95 % interval, from how far the points lie off it."""
    n = len(x)
    middle_x, middle_y = statistics.fmean(x), statistics.fmean(y)
    spread = sum((a - middle_x) ** 2 for a in x)
    rise = sum((a - middle_x) * (b - middle_y) for a, b in zip(x, y)) / spread
    left = sum((b - middle_y - rise * (a - middle_x)) ** 2 for a, b in zip(x, y))
    return rise, STUDENT[n - 2] * math.sqrt(left / (n - 2) / spread)
