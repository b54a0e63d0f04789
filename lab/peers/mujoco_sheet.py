"""The swinging sheet of `singe bench swing` as a flex of MuJoCo, for scripts/bench_peers.py.

Usage: mujoco_sheet.py CELLS FRAMES STEPS ITERATIONS OUT: prints the milliseconds of processor time of each frame, and
writes the positions of its (CELLS + 1)^2 points, row by row, to OUT."""
import struct
import sys
import time

import mujoco


def model(cells, steps, iterations):
    """1 m x 1 m, 0.1 kg, held at two corners beside each other; edges are equalities."""
    return mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <option timestep="{1 / 24 / steps}" solver="CG" iterations="{iterations}" tolerance="1e-8" gravity="0 0 -9.81"
          integrator="implicitfast"/>
  <size memory="2G"/>
  <worldbody>
    <flexcomp name="sheet" type="grid" dim="2" count="{cells + 1} {cells + 1} 1" spacing="{1 / cells} {1 / cells} 1"
              mass="0.1" radius="0.0005">
      <edge equality="true" solref="{2 / 24 / steps} 1"/>
      <contact contype="0" conaffinity="0" selfcollide="none"/>
      <pin id="0 {cells}"/>
    </flexcomp>
  </worldbody>
</mujoco>""")


def main():
    cells, frames, steps, iterations = map(int, sys.argv[1:5])
    sheet = model(cells, steps, iterations)
    data = mujoco.MjData(sheet)
    mujoco.mj_forward(sheet, data)
    with open(sys.argv[5], "wb") as out:
        for _ in range(frames):
            began = time.process_time()
            for _ in range(steps):
                mujoco.mj_step(sheet, data)
            print(f"{1e3 * (time.process_time() - began):.4f}", flush=True)
            out.write(struct.pack(f"={data.flexvert_xpos.size}f", *data.flexvert_xpos.ravel()))


if __name__ == "__main__":
    main()
