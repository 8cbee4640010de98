from collections.abc import Callable, Sequence
from typing import Any

__version__: str

class SceneError(ValueError): ...

def describe(name: str, text: str) -> tuple[str, str, list[str]]: ...
def run(
    name: str,
    text: str,
    replicas: int | None = None,
    seed: int | None = None,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> dict[str, Any]: ...
def call(arguments: Sequence[str]) -> tuple[int, str]: ...
def main(program: Sequence[str], arguments: Sequence[str]) -> None: ...
