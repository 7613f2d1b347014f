#!/usr/bin/env python3
"""Prints the page of file formats, made of the library's table (tools/docs.sh)."""

import blum

print("# File formats\n")
for content in dict.fromkeys(row.content for row in blum.file_formats()):
    print(f"## {content.capitalize()}\n")
    print("| format | read | written | holds | opens in |\n|---|---|---|---|---|")
    for row in blum.file_formats(content):
        read, written = (" ".join(f"`{end}`" for end in ends) for ends in (row.extensions, row.written))
        print(f"| {row.name} | {read} | {written} | {row.holds} | {row.opens_in} |")
    print()
