#!/usr/bin/env python3
"""Whatever picture or file of this repository a document points at is there.

    links_test.py SOURCE_DIR
"""

import pathlib
import re
import sys

LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s#]+)(?:#[^)]*)?\)")


def documents(source):
    """All but what is built or downloaded."""
    for path in sorted(source.rglob("*.md")):
        if path.relative_to(source).parts[0] not in ("build", ".git"):
            yield path


def broken(document):
    text = re.sub(r"```.*?```|`[^`\n]*`", "", document.read_text(), flags=re.DOTALL)
    for target in LINK.findall(text):
        if "://" not in target and not (document.parent / target).exists():
            yield target


def main():
    source = pathlib.Path(sys.argv[1])
    found = [f"{document.relative_to(source)}: {target} is not there"
             for document in documents(source) for target in broken(document)]
    print("\n".join(found))
    checked = sum(1 for _ in documents(source))
    if not checked:
        print(f"no documents in {source}")
    return 1 if found or not checked else 0


if __name__ == "__main__":
    sys.exit(main())
