"""Trees that learn from rays: what they save, and where it does not pay."""

import sys
import time

import numpy as np

from bspcsg import bsp

count = int(sys.argv[2]) if len(sys.argv) > 2 else 1500
rng = np.random.default_rng(1)


def cloud(spread):
    """Triangles here and there, some of them crossing; their sizes differ if spread is not 0."""
    sizes = 0.3 * np.exp(spread * rng.normal(size=(count, 1, 1)))
    return rng.uniform(-10, 10, (count, 1, 3)) + rng.normal(size=(count, 3, 3)) * sizes


batch, rounds = 1000, 12


def skewed(n):
    """From one corner through a narrow window: few triangles get nearly all the hits."""
    aims = np.array([6, 5, -6]) + rng.normal(size=(n, 3)) * 0.6
    return np.full((n, 3), 12.0), aims - 12.0


def uniform(n):
    """From everywhere to everywhere."""
    ends = rng.normal(size=(2, n, 3))
    origins, aims = 17 * ends / np.linalg.norm(ends, axis=2, keepdims=True)
    return origins, aims - origins


def grown(make):
    begun = time.perf_counter()
    return make(), time.perf_counter() - begun


panels = [
    ("skewed rays, many sizes", skewed, cloud(1)),
    ("skewed rays, like sizes", skewed, cloud(0)),
    ("uniform rays, many sizes", uniform, cloud(1)),
]
heading = "build s  rays s    tree   per ray: visited  stabbed  tested"
for name_of_panel, rays, facets in panels:
    sample = rays(2000)
    trees = {
        "one leaf": grown(lambda facets=facets: bsp.AdaptiveTree(facets, threshold=10**9)),
        "random": grown(lambda facets=facets: bsp.StaticTree(facets, order="random")),
        "by score": grown(lambda given=(facets, *sample): bsp.optimised_tree(*given)),
        "self-organising": grown(lambda facets=facets: bsp.AdaptiveTree(facets, threshold=40)),
    }
    batches = [rays(batch) for _ in range(rounds)]
    print(f"{name_of_panel:24} {heading}")
    answers = []
    for name, (tree, build) in trees.items():
        begun = time.perf_counter()
        tests = [tree.test_ray(*given) for given in batches]
        took = time.perf_counter() - begun
        last = [getattr(tests[-1], column).mean() for column in ("nodes", "leaves", "tests")]
        print(
            f"  {name:22} {build:7.2f} {took:7.2f} {len(tree):7d}"
            f" {last[0]:18.1f} {last[1]:8.1f} {last[2]:7.1f}"
        )
        answers.append(np.concatenate([t.hits.facet for t in tests]))
    assert all((answer == answers[0]).all() for answer in answers)
print("All trees gave the same answer to every ray.")
