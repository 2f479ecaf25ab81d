#!/usr/bin/python3
"""scenes/scene.schema.json against every shipped scene and every broken one.

A broken scene (broken/NAME.json) must be refused by the schema, unless broken/NAME.expected ends
with "beyond the schema": then what is wrong with it ties two places of the file together, which a
schema cannot say, and the schema must accept it. usage: schema_test.py SOURCE_DIR
"""
import json
import pathlib
import sys

import jsonschema  # Debian: python3-jsonschema


def strict_json(path):
    """As the scene reader reads it: UTF-8, no duplicate keys, no NaN, finite numbers."""

    def unique(pairs):
        if len({key for key, _ in pairs}) < len(pairs):
            raise ValueError("duplicate key")
        return dict(pairs)

    def finite(text):
        number = float(text)
        if number in (float("inf"), float("-inf")):
            raise ValueError("not finite: " + text)
        return number

    def refuse(text):
        raise ValueError("not JSON: " + text)

    return json.loads(
        path.read_bytes().decode("utf-8"),
        object_pairs_hook=unique, parse_float=finite, parse_constant=refuse)


def problem(validator, path):
    try:
        scene = strict_json(path)
    except ValueError as error:  # syntax and encoding errors are ValueErrors too
        return str(error)
    error = jsonschema.exceptions.best_match(validator.iter_errors(scene))
    return None if error is None else error.message


def main():
    source = pathlib.Path(sys.argv[1])
    schema = json.loads((source / "scenes/scene.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)

    failures = []
    shipped = sorted((source / "scenes").glob("*/*.json"))
    broken = sorted((source / "tests/unit/scene/broken").glob("*.json"))
    if len(shipped) < 7 or len(broken) < 100:
        failures.append(f"only {len(shipped)} scenes and {len(broken)} broken ones found")
    for path in shipped:
        message = problem(validator, path)
        if message is not None:
            failures.append(f"{path}: refused: {message}")
    for path in broken:
        beyond = "beyond the schema" in path.with_suffix(".expected").read_text().splitlines()
        message = problem(validator, path)
        if beyond and message is not None:
            failures.append(f"{path}: said to be beyond the schema, but refused: {message}")
        if not beyond and message is None:
            failures.append(f"{path}: accepted")
    print("\n".join(failures) or f"{len(shipped)} scenes accepted, {len(broken)} broken ones told")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
