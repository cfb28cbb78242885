"""What the tests share: a floor seen from above, and a pipeline that is pushed such pictures."""

import os

import numpy as np
import pytest

import relief

ROOT = os.environ["RELIEF_ROOT"]


@pytest.fixture
def camera():
    return relief.Camera(160, 120, fx=120, fy=120, cx=79.5, cy=59.5)


@pytest.fixture
def floor():
    return np.full((120, 160), 2000, np.uint16)


@pytest.fixture
def pushed(camera):
    with relief.Pipeline(camera, gravity=(0, 0, 9.81), threads=1, render=False) as made:
        yield made
