"""Scenes that tests share: quick to run."""

import copy

RING = {
    "planet": {"preset": "saturn-a-ring"},
    "box": {"size": [60.0, 60.0]},
    "particles": {"optical_depth": 0.3, "density": 450.0, "sizes": {"law": "equal", "radius": 1.0}},
    "collisions": {"restitution": {"law": "constant", "value": 0.5}},
    "time": {"step": 2e-3, "end": 0.2},
}


def ring(**tables):
    """RING with other tables."""
    scene = copy.deepcopy(RING)
    scene.update(tables)
    return scene
