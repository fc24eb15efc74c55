# SPDX-FileCopyrightText: 2026 Framelet contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A live preview of one object: the mesh shows what the settings would give, until it gets its bits back.

`begin_preview`, `tick`, `end` and `apply` are plain calls on the main thread; a timer makes them.
"""

from __future__ import annotations

import traceback
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

from ..mesh_io import kept_original, mesh_bridge
from ..mesh_io.own_names import names_refusal
from ..modifier.inputs import input_values
from ..modifier.offsets import offset_of
from ..modifier.recipes import DISPLACEMENT
from ..modifier.stack import find_modifier
from ..properties.output_choices import IN_PLACE
from ..run.denoise_job import with_amount
from ..run.denoise_object import read_job, write_outcome
from ..run.denoise_run import Written
from ..run.output import refusal
from ..run.run_guard import find_mesh, find_object, mark_of, what_changed
from ..shortage import reserve_for_writing, shortage_told
from .outcomes import computed, recalled
from .picture_source import PictureSource, Shown

if TYPE_CHECKING:
    import bpy
    import numpy as np
    from numpy.typing import NDArray

    from ...core.settings import DenoiseSettings
    from ..properties.region_options import RegionOptions
    from ..run.denoise_job import DenoiseJob, DenoiseOutcome

FEW = 0.5
"""Share of the vertices up to which an edit counts as one of some vertices, whose way is kept. More are
moved by applying a scale and the like, after which the original does not belong to the mesh any more."""


class PreviewSession:
    """The preview of one object; `begin_preview` makes it.

    Attributes
    ----------
    name : str
        The object's name.
    mark : Mark
        What the object is recognized by.
    message : str
        One sentence if there is nothing to show with these settings, or on why the preview ended.
    """

    def __init__(self, obj: bpy.types.Object, job: DenoiseJob, options: RegionOptions) -> None:
        self.message = ""
        self.is_on = True
        self.mark = mark_of(obj)
        self._job = job
        self._options = options
        self._original = job.read.vertices
        self._shown = self._original
        self._wanted: DenoiseJob | None = None
        self._outcome: tuple[DenoiseJob, DenoiseOutcome] | None = None
        self._is_touched = self._is_any_touched = self._is_suspended = False
        self._is_allowed = True
        self._result: NDArray[np.float32] | None = None
        self._inputs: dict[str, object] = {}
        kept_original.keep(obj.data, self._original, self._shown)
        self._source = PictureSource(computed, recalled)

    @property
    def name(self) -> str:
        """The object's name when the preview began."""
        return self.mark.name

    @property
    def mesh_uid(self) -> int:
        """The `session_uid` of the mesh."""
        return self.mark.mesh_uid

    @property
    def is_current(self) -> bool:
        """Whether the mesh shows what was asked for last."""
        return self._outcome is not None and self._outcome[0] is self._wanted

    @property
    def fraction(self) -> float:
        """How much of what is being computed is done, from 0 to 1."""
        return self._source.fraction

    def find_object(self) -> bpy.types.Object | None:
        """Return the object; None if it is gone."""
        return find_object(self.mark)

    def touch(self, touched: set[int]) -> None:
        """Note the session numbers of objects and meshes that may have been edited, for the next tick."""
        self._is_any_touched = True
        if not touched.isdisjoint((self.mark.object_uid, self.mark.mesh_uid)):
            self._is_touched = True

    def tick(self, settings: DenoiseSettings, options: RegionOptions) -> bool:
        """Ask for what the settings give, and show what has been computed. Call it often.

        Parameters
        ----------
        settings : DenoiseSettings
            What to show.
        options : RegionOptions
            Where vertices may move.

        Returns
        -------
        bool
            False once the preview is over; `message` says why.
        """
        if not self.is_on or self._is_suspended:
            return self.is_on
        try:
            return self._tick(settings, options)
        except MemoryError:
            self.end(f"There is not enough memory for ‘{self.name}’, so that the preview ended.")
            return False

    def _tick(self, settings: DenoiseSettings, options: RegionOptions) -> bool:
        """Do so, with the memory that there is."""
        change = what_changed(self.mark, self._job.read)
        if change is not None:
            self.end(f"{change}, so that the preview ended.")
            return False
        if self._is_any_touched:
            self._is_any_touched = False
            kept_original.put_all_back(self.mark.mesh_uid)  # copies of what is shown
        if self._is_touched:
            self._is_touched = False
            if not self._keeps_showing():
                return False
        if options != self._options:
            self._read_again(options)
        if self._result is not None and self._modifier_inputs() != self._inputs:
            self._show(self._result)
        if not self._is_allowed:
            return True
        if self._wanted is None or settings != self._wanted.settings:
            self._wanted = replace(self._job, settings=settings)
            picture = self._source.request(self._wanted)
            if picture is not None:
                self._take(Shown(self._wanted, picture, None, None))
        shown = self._source.take()
        if shown is not None:
            self._take(shown)
        return True

    def wait(self, seconds: float) -> bool:
        """Wait for what is being computed, at most so long; return whether that is done."""
        return self._source.wait(seconds)

    def suspend(self) -> None:
        """Give the mesh its original positions until `resume`; for saving files."""
        mesh = find_mesh(self.mark)
        if self.is_on and not self._is_suspended and mesh is not None:
            self._is_suspended = True
            self._keep_again(mesh)
            if kept_original.has_kept(mesh):
                kept_original.put_back(mesh)

    def resume(self) -> None:
        """Show the preview again."""
        obj = self.find_object()
        if not self._is_suspended:
            return
        self._is_suspended = False
        if obj is not None and what_changed(self.mark, self._job.read) is None:
            reason = names_refusal(obj)
            if reason is not None:
                self.end(reason)
                return
            kept_original.keep(obj.data, self._original, self._shown)
            mesh_bridge.show_positions(obj.data, self._shown)

    def end(self, message: str = "") -> None:
        """End the preview and give the mesh its original positions, bit by bit.

        So do meshes that took its vertices over, as by a join. See `kept_original` for what was edited in
        ways that leave unknown where its vertices were.
        """
        if self._close(message):
            self._keep_again(find_mesh(self.mark))
            kept_original.put_all_back()

    def leave(self) -> None:
        """End the preview without touching the mesh; for a file that is being closed."""
        self._close("")

    def apply(self, output: str = IN_PLACE) -> Written:
        """End the preview and keep what it shows.

        Parameters
        ----------
        output : str
            One of `output_choices.OUTPUTS`.

        Raises
        ------
        ValueError
            In one sentence, if there is nothing to keep yet, or not there.
        """
        obj = self.find_object()
        if obj is None or not self.is_on or self._outcome is None or not self.is_current:
            raise ValueError("The preview does not show these settings yet; wait a moment and apply it then.")
        reason = refusal(obj, output)
        if reason is not None:
            raise ValueError(reason)
        outcome = self._outcome[1]
        with shortage_told(obj.name):
            reserve_for_writing(obj)
        self.end()
        written = write_outcome(obj, replace(self._outcome[0], output=output), outcome)
        return Written(obj, written.obj, with_amount(outcome.measured, written.amount), written.note)

    @property
    def has_ended(self) -> bool:
        """Whether the thread has ended too."""
        return self._source.has_ended

    def join(self) -> None:
        """Wait until the thread of a preview that is over has ended."""
        self._source.join()

    def _close(self, message: str) -> bool:
        """Stop computing; return whether the preview was on."""
        was_on, self.is_on = self.is_on, False
        if was_on:
            self.message = message
            self._source.close()
        return was_on

    def _keep_again(self, mesh: bpy.types.Mesh | None) -> None:
        """Keep the original once more, if somebody took the attributes from a mesh that shows the preview."""
        import numpy as np

        if mesh is None or mesh.is_editmode or kept_original.has_both(mesh):
            return
        if np.array_equal(mesh_bridge.read_positions(mesh), self._shown, equal_nan=True):
            kept_original.keep(mesh, self._original, self._shown)

    def _read_again(self, options: RegionOptions) -> None:
        """Read where vertices may move, on the original; with options that do not fit, show it."""
        obj = self.find_object()
        assert obj is not None  # `tick` has looked
        self._options, self._wanted = options, None
        self._source.forget()
        self.suspend()
        try:
            job = read_job(obj, self._job.settings, IN_PLACE, options, from_original=True)
            self._job = replace(job, surface=self._job.surface, present=self._job.present)
            self._is_allowed = True
        except ValueError as error:
            self._is_allowed, self._outcome, self._result = False, None, None
            self._shown, self.message = self._original, str(error)
        finally:
            self.resume()

    def _keeps_showing(self) -> bool:
        """Look whether the mesh shows what it should; if it was edited, keep the edit and end."""
        import numpy as np

        obj = self.find_object()
        assert obj is not None
        now = mesh_bridge.read_positions(obj.data)
        edited = (now.view(np.uint32) != self._shown.view(np.uint32)).any(axis=1)
        if not edited.any():
            return True
        if edited.mean() < FEW:
            positions = self._original.copy()
            positions[edited] += now[edited] - self._shown[edited]
            kept_original.keep(obj.data, positions, now)
        if kept_original.put_back(obj.data):
            self.end(f"The mesh of ‘{self.name}’ was edited, so that the preview ended.")
        else:
            self.end(
                f"All of ‘{self.name}’ was edited; it keeps what the preview showed. Undo brings it back."
            )
        return False

    def _take(self, shown: Shown) -> None:
        """Show an answer; with an error, the original and a sentence."""
        if shown.positions is not None:
            self.message = ""
            if shown.outcome is not None:
                self._outcome = shown.job, shown.outcome
            self._result = shown.positions
            self._show(self._result)
            return
        error = shown.error
        if not isinstance(error, ValueError):
            traceback.print_exception(error)
        self._outcome = self._result = None
        self.message = str(error) if isinstance(error, ValueError) else f"An unexpected error: {error!r}."
        self._show(self._original)

    def _modifier_inputs(self) -> dict[str, object]:
        """Return the inputs of the modifier that adds the result of a run before; empty without one."""
        modifier = find_modifier(self.find_object(), DISPLACEMENT)
        return {} if modifier is None else input_values(modifier)

    def _show(self, positions: NDArray[np.float32]) -> None:
        """Write positions to the mesh, less what the modifier adds to a result."""
        obj = self.find_object()
        assert obj is not None  # `tick` has looked
        if positions is self._result:
            self._inputs = self._modifier_inputs()
            with suppress(ValueError):  # with a mask that only nodes can read, both are added
                added = offset_of(obj, DISPLACEMENT)
                positions = positions if added is None else positions - added
        kept_original.keep(obj.data, self._original, positions)
        mesh_bridge.show_positions(obj.data, positions)
        self._shown = positions


def begin_preview(obj: bpy.types.Object, settings: DenoiseSettings, options: RegionOptions) -> PreviewSession:
    """Start a preview; `tick` asks for the first result.

    Raises
    ------
    ValueError
        In one sentence, if there can be none of this object.
    """
    if obj.mode != "OBJECT":
        raise ValueError(f"‘{obj.name}’: the preview needs Object Mode; leave the mode first.")
    with shortage_told(obj.name):
        job = read_job(obj, settings, IN_PLACE, options, from_original=True)
    if job.is_level:
        raise ValueError(
            f"‘{obj.name}’ has a Multires modifier, of which there is no preview; press Denoise instead."
        )
    if obj.data.shape_keys is not None:
        raise ValueError(f"‘{obj.name}’ has shape keys, of which there is no preview; press Denoise.")
    return PreviewSession(obj, job, options)
