# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators: burn (also preview and resume), cancel, free and load."""

import os
import subprocess
import traceback

import bpy
from bpy.props import BoolProperty, StringProperty

from . import export, files, job, load, properties

EVERY = 0.25  # s between polls


def burn_folder(scene, preview=False):
    path = bpy.path.abspath(scene.singe.folder or "//singe")
    if path.startswith("//") or not os.path.isabs(path):
        raise export.ExportError("save the .blend file first, or choose a cache folder with an absolute path")
    if os.sep != "\\" and "\\" in path:
        raise export.ExportError(f"{path} has a \\ in its name, which Blender takes for a /: choose another cache folder")
    return os.path.join(path, "preview" if preview else "burn")


def say(scene, text, failed=False):
    scene.singe.message, scene.singe.failed = text, failed


def redraw(context):
    for window in context.window_manager.windows if context.window_manager else ():
        for area in window.screen.areas:
            if area.type in {"PROPERTIES", "VIEW_3D"}:
                area.tag_redraw()


def frame_count(scene):
    return scene.frame_end - scene.frame_start + 1


def branch_frame(scene):
    """The current frame's number in a burn, from 1."""
    return scene.frame_current - scene.frame_start + 1


class Burning:
    """A job and its display in the scene; shared by burn, preview, resume and branch."""

    def begin_job(self, context, preview, resume, branch=False):
        scene = context.scene
        folder = burn_folder(scene, preview)
        if folder in job.RUNNING:
            raise export.ExportError("this scene is already burning")
        if frame_count(scene) < 2:
            raise export.ExportError("the scene has only one frame: set its end frame")
        program = job.find_program(properties.chosen_program(context))
        if resume:
            if not files.is_own(folder):
                raise export.ExportError(f"{folder} has no burn to resume")
            files.take(folder)
        elif branch:
            frame = branch_frame(scene)
            if not files.is_own(folder) or not job.can_branch(os.path.join(folder, "cache"), frame, frame_count(scene)):
                raise export.ExportError(f"the burn has no frame {scene.frame_current} to continue from: move to one that "
                                         "is burnt and is not the scene's last")
            load.clear(context, os.path.join(folder, "cache"))
            files.set_aside(folder)
            try:
                export.Exporter(context, folder).write()
                self.job = job.Job(program, folder, frame_count(scene), branch=frame)
            except BaseException:
                files.put_back(folder)
                raise
        else:
            load.clear(context, os.path.join(folder, "cache"))
            export.Exporter(context, folder, preview).write()
        if not branch:
            self.job = job.Job(program, folder, frame_count(scene), resume)
        self.root_time, self.shown = None, -1
        scene.singe.progress = 0
        say(scene, "burning")

    def look(self, context):
        """Updates the progress and loads new frames. Returns False if the job had already ended."""
        scene, running = context.scene, self.job.running()
        frames = self.job.frames_done()
        if frames != self.shown:
            self.shown = frames
            scene.singe.progress = frames / self.job.frames
            say(scene, f"frame {frames} of {self.job.frames}")
            redraw(context)
        found = job.root_of(self.job.cache) if frames else None
        time = os.stat(found[0]).st_mtime_ns if found else None
        fresh = found and time != self.root_time and (self.job.resumed or time > (self.job.started or (0, 0))[1])
        # in a root of one frame nothing moves, and Blender makes no Mesh Sequence Cache of it
        if fresh and job.root_frames(found[0]) > 1:
            self.root_time = time
            if load.is_loaded(self.job.cache):
                load.grow(context, self.job.cache)
            else:
                load.load(context, self.job.cache)
        return running

    def end_job(self, context):
        """Returns whether the job has completed. If not, the scene's message says why."""
        code, said = self.job.finish()
        self.look(context)
        scene, frames = context.scene, self.job.frames_done()
        if code == 0:
            say(scene, f"{frames} frames burnt" + (f"; {said}: see Lit By" if said else ""))
        elif said:
            say(scene, said, True)
        elif not frames:
            say(scene, f"the program has ended before the first frame, with code {code} and without a reason", True)
        else:
            say(scene, f"stopped after frame {frames} of {self.job.frames}; Resume continues the burn")
        scene.singe.progress = frames / self.job.frames
        redraw(context)
        return code == 0


# errors that the user can fix
ERRORS = (export.ExportError, files.FolderError, load.LoadError, job.ProgramError, OSError, RuntimeError)


class SINGE_OT_burn(bpy.types.Operator, Burning):
    """Burn the scene's sheets in the background; the cache is loaded as it grows"""
    bl_idname = "singe.burn"
    bl_label = "Burn"

    preview: BoolProperty(options={"SKIP_SAVE"}, description="Coarse, without gas")
    resume: BoolProperty(options={"SKIP_SAVE"}, description="Continue a burn that was stopped")
    branch: BoolProperty(options={"SKIP_SAVE"},
                         description="Keep the burn up to the current frame, and continue with what has changed since: wind, "
                                     "pins, colliders, fire, materials, pace")

    def _begin(self, context):
        try:
            self.begin_job(context, self.preview, self.resume, self.branch)
        except Exception as error:
            self._fail(context, error)
            return False
        return True

    def _fail(self, context, error):
        said = files.sentence(error)
        if not isinstance(error, ERRORS):  # unexpected scene content
            traceback.print_exception(error)
            said = f"the extension cannot use this scene: {type(error).__name__}: {said}; the console shows more"
        say(context.scene, said, True)
        self.report({"ERROR"}, said)
        return {"CANCELLED"}

    def execute(self, context):
        """Waits until the burn ends; for scripts and for Blender without a window."""
        if not self._begin(context):
            return {"CANCELLED"}
        try:
            while self.look(context):
                try:
                    self.job.process.wait(EVERY)
                except subprocess.TimeoutExpired:
                    pass
        except KeyboardInterrupt:
            self.job.stop()
        except Exception as error:
            return self._abandon(context, error)
        try:
            if self.end_job(context):
                return {"FINISHED"}
        except Exception as error:
            return self._abandon(context, error)
        self.report({"ERROR"}, context.scene.singe.message)
        return {"CANCELLED"}

    def _abandon(self, context, error):
        """Stops the program because what it has written cannot be shown."""
        self.job.stop()
        self.job.finish()
        return self._fail(context, error)

    def invoke(self, context, event):
        if bpy.app.background:
            return self.execute(context)
        if not self._begin(context):
            return {"CANCELLED"}
        self.timer = context.window_manager.event_timer_add(EVERY, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        result = {"FINISHED"}
        try:
            if self.look(context):
                return {"PASS_THROUGH"}
            if not self.end_job(context) and context.scene.singe.failed:
                self.report({"ERROR"}, context.scene.singe.message)
        except Exception as error:
            result = self._abandon(context, error)
        context.window_manager.event_timer_remove(self.timer)
        return result


class SINGE_OT_cancel(bpy.types.Operator):
    """Stop after the current step. Resume continues from there"""
    bl_idname = "singe.cancel"
    bl_label = "Cancel"

    def execute(self, context):
        for running in list(job.RUNNING.values()):
            running.stop()
        return {"FINISHED"}


class SINGE_OT_free(bpy.types.Operator):
    """Delete the files that Burn and Preview wrote, and everything loaded from them"""
    bl_idname = "singe.free"
    bl_label = "Free Cache"

    def invoke(self, context, event):
        return context.window_manager.invoke_confirm(self, event)

    def execute(self, context):
        message = ""
        try:
            for preview in (False, True):
                folder = burn_folder(context.scene, preview)
                if folder in job.RUNNING:
                    self.report({"ERROR"}, "the scene is burning: cancel it first")
                    return {"CANCELLED"}
                load.clear(context, os.path.join(folder, "cache"))
                if files.free(folder) and os.path.isdir(folder):
                    message = f"{files.printable(folder)} has files that Singe did not make: they stay"
        except ERRORS as error:
            self.report({"ERROR"}, files.sentence(error))
            return {"CANCELLED"}
        context.scene.singe.progress = 0
        say(context.scene, message)
        return {"FINISHED"}


class SINGE_OT_load(bpy.types.Operator):
    """Load the cache of any run of Singe"""
    bl_idname = "singe.load"
    bl_label = "Load Cache"
    bl_options = {"REGISTER", "UNDO"}

    directory: StringProperty(subtype="DIR_PATH")
    filepath: StringProperty(subtype="FILE_PATH", options={"HIDDEN", "SKIP_SAVE"})

    def invoke(self, context, event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context):
        folder = bpy.path.abspath(self.directory or os.path.dirname(self.filepath))
        try:
            frames = load.load(context, folder.rstrip("/\\"))
        except Exception as error:  # the folder may hold anything, and a traceback tells a user nothing
            self.report({"ERROR"}, f"cannot load {files.printable(folder)}: {files.sentence(error)}")
            return {"CANCELLED"}
        say(context.scene, f"{frames} frames loaded")
        self.report({"INFO"}, context.scene.singe.message)
        return {"FINISHED"}


CLASSES = (SINGE_OT_burn, SINGE_OT_cancel, SINGE_OT_free, SINGE_OT_load)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for running in list(job.RUNNING.values()):
        running.stop()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
