"""Builds the recipe for conda and installs it into a prefix (PyPI's py-rattler-build and py-rattler), without any channel.

usage: conda.py RECIPE FOLDER      FOLDER/channel and FOLDER/prefix are made; SINGE_VERSION is the version
"""

import asyncio
import pathlib
import shutil
import sys

import rattler
from rattler_build import Stage0Recipe, VariantConfig


async def install(channel, prefix):
    records = await rattler.solve(sources=[rattler.Channel(channel.as_uri())], specs=["singe"],
                                  platforms=[rattler.Platform.current(), "noarch"], gateway=rattler.Gateway())
    await rattler.install(records, prefix)


def main():
    recipe, folder = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
    channel, prefix = folder / "channel", folder / "prefix"
    for place in (channel, prefix):
        shutil.rmtree(place, ignore_errors=True)
    for variant in Stage0Recipe.from_file(recipe).render(VariantConfig({"tools": ["system"]})):
        variant.run_build(output_dir=channel, channels=[])  # and the recipe's own tests
    asyncio.run(install(channel, str(prefix)))


if __name__ == "__main__":
    main()
