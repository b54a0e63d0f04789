#!/usr/bin/env python3
"""Changes lines of the core one at a time, in a copy, and shows that each change dies in the test that is named for it.

    tests/mutations/mutations.py [--only WORD] [--check] [--jobs N] [--folder DIR]

Every row of MUTATIONS is a file of src, a text that stands in it exactly once, what it becomes, a test, and the pattern
of its cases. First all named tests must pass unchanged. Then a change survives if its test still passes, or does not
build; the command ends with 1 if one does. The copy and its build stay in DIR for the next time.
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent

MUTATIONS = [
    # eq 1 to 3: heat
    ("heat/heat.c", "Float4 T1 = four->T + four->combustion", "Float4 T1 = four->T - four->combustion",
     "heat_exchange", "combustion_is_eta_times_burnt_mass"),
    ("heat/heat.c", "four->loss = rate * over / (one + rate);", "four->loss = rate * over;",
     "heat_exchange", "one_step_of_losses_matches_the_formula"),
    ("heat/source.c", "float reach = def->radius + def->falloff", "float reach = def->radius",
     "heat_source", "falls_off_smoothly_and_moves"),
    ("heat/conduct.c", "double rise = (double)pass->dt * inflow[i % HEAT_ROWS] / plan->measure[i];",
     "double rise = 0.9 * (double)pass->dt * inflow[i % HEAT_ROWS] / plan->measure[i];",
     "heat_diffusion", "slab_mode_decays_with_second_order"),
    ("heat/operator.c", "double flux = square > 0 ? (double)(face / square) : 0;",
     "double flux = square > 0 ? (double)(face / square / 2) : 0;",
     "heat_diffusion", "gaussian_spreads_at_the_right_rate"),
    ("heat/operator.c", "plan->measure[a] += length / 2;", "plan->measure[a] += length;",
     "heat_diffusion", "umbrella_has_its_derived_diffusivity"),
    ("heat/operator.c", "return float_max(length, LIVE_LENGTH_MIN * rest);", "return rest;",
     "heat_diffusion", "the_printed_umbrella_uses_current_lengths"),
    # eq 4 to 6: burning
    ("burn/lose_mass.c", "if (p == 0.0f) return k > x ? x : k;", "if (p == 0.0f) return k > x ? x : 0.9f * k;",
     "burn", "no_exponent_is_a_straight_line"),
    ("burn/lose_mass.c", "if (excess > ceiling) excess = ceiling;", "(void)ceiling;",
     "burn", "rate_stops_growing_at_its_ceiling"),
    ("burn/lose_mass.c", "pyrolysis(job, i, excess + heats * pyrolysis(job, i, excess));", "pyrolysis(job, i, excess);",
     "burn", "fuel_heats_itself_to_second_order"),
    ("heat/heat.c", "pass.theta = stiffness > 2 ? 1 - 1 / stiffness : 0.5f;", "pass.theta = 1;",
     "heat_front", "front_speed_does_not_depend_on_steps"),
    ("burn/supply.c", "return share;", "return float4_all(1);",
     "burn", "a_large_area_burns_what_it_has_air_for"),
    ("burn/supply.c", "AIR_REACH = 0.015f;", "AIR_REACH = 0.005f;",
     "heat_front", "a_wide_front_is_not_short_of_air"),
    ("shell/target_length.h", "(char_density - 1) * (1 - fuel)", "(char_density - 1) * fuel",
     "burn", "volume_ratio_follows_eq_5"),
    ("shell/target_length.h", "ratio = 1 - shrink * (1 - 0.5f * (a.volume + b.volume));",
     "ratio = 1 - shrink * (1 - a.volume);", "burn", "springs_shrink_by_eq_6"),
    ("shell/target_length.h", "whole = (1 - even) * (q - 1) / (q + 1);", "whole = (1 - even) * (1 - q) / (q + 1);",
     "burn", "fibres_turn_shrinkage"),
    # section 6 and eq 7: what goes
    ("ablate/ablate_plan.c", "return state->burn.mass[particle] - field_at(matter->mass_loss, particle);",
     "return state->burn.mass[particle] - 0.9f * field_at(matter->mass_loss, particle);",
     "ablate", "level_is_mass_above_loss"),
    ("ablate/ablate_step.c", "if (other == SHELL_NONE || !(removal->ablate->cell_flags[other] & SINGE_ALIVE))",
     "if (true)", "ablate", "blue_goes_with_the_last_of_its_cells"),
    ("ablate/ablate_step.c", "            for (int i = 0; i < 4; i++) left |= plan->level[context->shell->cells[c][i]] >= 0;",
     "            for (int i = 1; i < 4; i++) left |= plan->level[context->shell->cells[c][i]] >= 0;",
     "ablate", "a_cell_keeps_its_springs_till_it_goes"),
    ("ablate/ablate_step.c", "for (int i = 0; i < 2; i++) remove_spring(&removal, SINGE_YELLOW, springs->yellow[i]);",
     "for (int i = 0; i < 1; i++) remove_spring(&removal, SINGE_YELLOW, springs->yellow[i]);",
     "ablate", "yellow_and_green_go_with_the_cell"),
    ("surface/surface.c", "float t = inside / (inside - outside);", "float t = 0.9f * inside / (inside - outside);",
     "surface", "one_cell_is_cut_by_its_levels"),
    # eq 8 to 15: motion
    ("dynamics/move_kernel.h", "velocity = (velocity + lanes_quadruple(job->fall)) * keep;",
     "velocity = (velocity + lanes_all(0.9f) * lanes_quadruple(job->fall)) * keep;",
     "motion", "a_sheet_falls_freely"),
    ("dynamics/move_kernel.h", "velocity = velocity + (point - old_predicted) * lanes_all(job->inverse_h);",
     "velocity = velocity + (point - old_predicted) * lanes_all(0.9f * job->inverse_h);",
     "dynamics_internal", "compliant_springs_swing_with_their_period_and_energy"),
    ("dynamics/move_kernel.h", "velocity - slip * k / (one + k) * normal,",
     "velocity - lanes_all(0.9f) * slip * k / (one + k) * normal,", "motion", "drag_gives_a_terminal_speed"),
    ("dynamics/plane_kernel.h", "max = lanes_all(plane->friction) * depth;",
     "max = lanes_all(0.5f * plane->friction) * depth;", "motion", "friction_holds_a_block_on_a_slope"),
    # eq 10 to 19: projection
    ("dynamics/strand/strand_kernel.h", "Lanes e = square - target;",
     "Lanes e = (square - target) * lanes_all(0.9f);", "strand_project", "chains_match_a_dense_solver"),
    ("dynamics/strand/strand_kernel.h", "mu = lanes_load(keep_at(group, k, KEEP_RIGHT)) + factor * mu;",
     "mu = lanes_load(keep_at(group, k, KEEP_RIGHT));", "strand_project", "chains_match_a_dense_solver"),
    ("dynamics/strand/strand_solver.c", "strands_project_colour(plan, solver->order[i], pool, h, count,",
     "strands_project_colour(plan, solver->order[3 - i], pool, h, count,",
     "paper", "the_last_colour_of_the_order_is_satisfied_best"),
    ("dynamics/smooth_kernel.h", "vb + lanes_all(2) * wb * j", "vb + wb * j",
     "dynamics_internal", "friction_keeps_momentum"),
    # the paper's own solver
    ("reference/conjugate_gradient.c", "job.beta = rest / before;", "job.beta = 0;",
     "paper", "conjugate_gradients_end_after_as_many_iterations_as_unknowns"),
    ("reference/fast_projection.c", "diagonal += 0.5 * group->regularisation * both", "diagonal += group->regularisation * both",
     "paper", "projection_matches_a_dense_solver"),
    ("reference/mass_spring.c", "double size = stiffness * (distance - job->group->length[k])",
     "double size = 0.9 * stiffness * (distance - job->group->length[k])", "paper", "a_spring_has_its_period"),
    # what the paper lacks: attachments, creases, tears
    ("dynamics/attach_kernel.h", "limit = max[k] * max[k];", "limit = 1.1f * max[k] * max[k];", "attach", "*"),
    ("dynamics/crease.c", "hinge.max = real_atan2f(2 * thickness, hinge.arc);",
     "hinge.max = real_atan2f(thickness, hinge.arc);", "crease", "*"),
    ("tear/line_force.c", "along /= float4_all(shell", "along /= 2 * float4_all(shell",
     "tear", "line_force_of_a_hanging_strip_equals_its_weight"),
]


def run(command, **options):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)


def copy(folder):
    """The tracked files as they are now. Files that have not changed keep their time, so that little is built again."""
    names = run(["git", "ls-files", "-z"], cwd=ROOT).stdout.split("\0")
    for name in filter(None, names):
        source, target = ROOT / name, folder / name
        if not source.is_file():
            continue
        data = source.read_bytes()
        if target.is_file() and target.read_bytes() == data:
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, target)
        shutil.copymode(source, target)


def build(folder, tests, jobs):
    return run(["cmake", "--build", folder / "build", "-j", str(jobs), "--target", *(f"test_{t}" for t in tests)])


def passes(folder, test, cases):
    """True, False, or None if no case has such a name."""
    program = next((folder / "build" / "tests").glob(f"*/test_{test}"))
    result = run([program], cwd=folder, env={**os.environ, "SINGE_TEST_FILTER": cases}, timeout=120)
    if "] 0 test(s) run" in result.stdout:
        return None
    return result.returncode == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--only", default="", help="the rows whose file, test or cases contain this")
    parser.add_argument("--check", action="store_true", help="only whether every text still stands in its file once")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--folder", type=pathlib.Path, default=ROOT / "build" / "mutations")
    options = parser.parse_args()
    chosen = [m for m in MUTATIONS if any(options.only in m[k] for k in (0, 3, 4))]
    folder = options.folder.resolve()

    for file, old, _, _, _ in chosen:
        path = ROOT / "src" / file
        count = path.read_text().count(old) if path.is_file() else 0
        if count != 1:
            sys.exit(f"src/{file}: the text stands in it {count} times, not once: {old}")
    if options.check:
        return 0

    copy(folder)
    configured = run(["cmake", "-S", folder, "-B", folder / "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release"])
    if configured.returncode:
        sys.exit(configured.stdout)
    tests = sorted({m[3] for m in chosen})
    built = build(folder, tests, options.jobs)
    if built.returncode:
        sys.exit(built.stdout[-4000:])
    for test, cases in sorted({(m[3], m[4]) for m in chosen}):
        if not passes(folder, test, cases):
            sys.exit(f"{test}: {cases} does not pass, or is not there, before anything is changed")

    survivors = 0
    begun = time.time()
    for file, old, new, test, cases in chosen:
        path = folder / "src" / file
        text = path.read_text()
        path.write_text(text.replace(old, new))
        try:
            good = build(folder, [test], options.jobs).returncode == 0
            try:
                dies = good and passes(folder, test, cases) is False
            except subprocess.TimeoutExpired:
                dies = True
        finally:
            path.write_text(text)
        survivors += not dies
        verdict = "dies" if dies else "survives" if good else "does not build"
        print(f"{verdict:14} {file}: {new}\n{'':14}   {test}: {cases}", flush=True)
    print(f"{len(chosen) - survivors} of {len(chosen)} die, in {time.time() - begun:.0f} s")
    return survivors > 0


if __name__ == "__main__":
    sys.exit(main())
