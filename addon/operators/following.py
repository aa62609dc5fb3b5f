# SPDX-License-Identifier: GPL-3.0-or-later
"""The base of operators that follow a long run, such as one in another Blender."""

import bpy

from ..core.run import Progress, Run, RunError, wait_for
from ..text import label
from .redraw import redraw_panels

_INTERVAL = 0.25  # seconds between looks at the run


class FollowsRun:
    """Shows how far a run is, ends it on Esc, and takes its result.

    A subclass has `title`, start() and finish(). `progress` is that of the present run, None if
    there is none. With `alone` everything else waits, as for work on the scene itself.
    """

    title = ""
    alone = False
    progress: Progress | None = None

    _run: Run | None = None
    _timer: bpy.types.Timer | None = None

    def start(self, context: bpy.types.Context) -> Run:
        """Return a new run. Raises RunError if it cannot begin."""
        raise NotImplementedError

    def finish(self, context: bpy.types.Context, result: object) -> set[str]:
        """Take the result of the run and return what the operator does."""
        raise NotImplementedError

    @classmethod
    def is_idle(cls) -> bool:
        """Return whether no run is under way; poll() shows the reason."""
        if cls.progress is not None:
            cls.poll_message_set("It is under way: Esc cancels it")
        return cls.progress is None

    def wait(self, context: bpy.types.Context) -> set[str]:
        """Run and wait for the end, as scripts expect."""
        manager = context.window_manager
        manager.progress_begin(0, 100)
        try:
            run = self.start(context)
            try:
                result = wait_for(run, lambda done: manager.progress_update(100 * done.part))
            finally:
                run.close()
        except RunError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        finally:
            manager.progress_end()
        return self.finish(context, result)

    def follow(self, context: bpy.types.Context) -> set[str]:
        """Run while Blender stays usable. Without a window, wait."""
        if bpy.app.background:
            return self.wait(context)
        try:
            self._run = self.start(context)
        except RunError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        manager = context.window_manager
        self._timer = manager.event_timer_add(_INTERVAL, window=context.window)
        manager.progress_begin(0, 100)
        manager.modal_handler_add(self)
        self._show(context, self._run.progress())
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Show how far it is; take the result at the end; end it on Esc."""
        if event.type == "ESC" and event.value == "PRESS":
            self.cancel(context)
            self.report({"INFO"}, label("{title}: cancelled", title=label(self.title)))
            return {"CANCELLED"}
        going_on = {"RUNNING_MODAL" if self.alone else "PASS_THROUGH"}
        if event.type != "TIMER":
            return going_on
        try:
            if self._run.advance():
                self._show(context, self._run.progress())
                return going_on
            result = self._run.result()
        except RunError as error:
            self.cancel(context)
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        except BaseException:
            self.cancel(context)
            raise
        self.cancel(context)
        return self.finish(context, result)

    def cancel(self, context: bpy.types.Context) -> None:
        """End the run, also if Blender quits or loads another file."""
        self._run.close()
        type(self).progress = None
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        if context.workspace is not None:  # None if Blender quits or loads another file
            context.workspace.status_text_set(None)
        redraw_panels(context)

    def _show(self, context: bpy.types.Context, progress: Progress) -> None:
        context.window_manager.progress_update(100 * progress.part)
        if progress == self.progress:
            return
        type(self).progress = progress
        text = label("{title}: Esc cancels", title=label(self.title))
        context.workspace.status_text_set(f"{text}  |  {progress.text}")
        redraw_panels(context)
