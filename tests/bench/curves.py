"""Error over time: when does a method reach an error?"""

import math


def time_to(points, target):
    """Seconds until an error is within `target`, by straight lines between the measured points
    [(error, seconds)] on a log-log plot; None beyond the smallest error. A curve that is better
    everywhere costs what its cheapest point costs."""
    points = sorted((max(error, 1e-12), seconds) for error, seconds in points)
    if points[0][0] > target:
        return None
    within = [point for point in points if point[0] <= target]
    beyond = [point for point in points if point[0] > target]
    best = min(seconds for _, seconds in within)
    if not beyond:
        return best
    (e0, s0), (e1, s1) = within[-1], beyond[0]
    share = math.log(target / e0) / math.log(e1 / e0)
    return min(best, s0 * (s1 / s0) ** share)


def time_with_noise(points, target):
    """The same for a method whose error is noise, which falls with the square root of its samples:
    (seconds, whether that is beyond what was measured)."""
    measured = time_to(points, target)
    if measured is not None:
        return measured, False
    error, seconds = min(points)
    return seconds * (error / target) ** 2, True
