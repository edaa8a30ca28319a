"""All hard cases."""

from reproduction.hard_cases import extreme_observables, extreme_questions, extreme_scenes
from reproduction.hard_cases.record import Case

CASES: list[Case] = [
    *extreme_scenes.CASES,
    *extreme_questions.CASES,
    *extreme_observables.CASES,
]
