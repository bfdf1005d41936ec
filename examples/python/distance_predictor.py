"""A predictor: the probability that two vehicles are linked, from their dead-reckoned distance and the age of their reports.

    clearway run intersection --policy dissertation --failure B10 --predictor distance_predictor.py:ByDistance
"""
import math

import numpy as np

from clearway import Predictor


class ByDistance(Predictor):
    speed_change_mps = 2.5  # how fast the error of a place grows

    def predict(self, observation):
        sigma_m = np.hypot(observation.sensor_sigma_m, self.speed_change_mps * observation.age_s)
        left, right = observation.pairs
        spread_m = np.maximum(np.hypot(sigma_m[left], sigma_m[right]), 1e-6)
        score = (observation.link_radius_m - observation.pair_dead_reckoned_m) / spread_m
        return np.array([0.5 * math.erfc(-one / math.sqrt(2.0)) for one in score])
