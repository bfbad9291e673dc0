"""A cluster for a test: kept for others, its processes would be at work all the time in between."""

import pytest
from distributed import Client, LocalCluster


@pytest.fixture
def cluster():
    """A client of a scheduler with two workers, each a process."""
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0") as local,
        Client(local) as client,
    ):
        yield client
