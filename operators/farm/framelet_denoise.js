// SPDX-FileCopyrightText: 2026 Framelet contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// A job type for Flamenco: denoise the meshes of a manifest in many tasks. Put this file into the folder
// `scripts` beside the Flamenco Manager. The Blender of each worker needs Framelet.
//
// Each task is one slice with a report of its own; done once more, it does only what is missing. No shell is
// involved: arguments reach Blender as they are.

const JOB_TYPE = {
  label: "Framelet Denoise",
  description: "Denoise the meshes of a manifest",
  settings: [
    {
      key: "manifest",
      type: "string",
      subtype: "file_path",
      required: true,
      description: "A .csv or .jsonl file with a row a mesh",
    },
    {
      key: "out",
      type: "string",
      subtype: "dir_path",
      required: true,
      description: "The folder for results and reports, the same on all workers",
    },
    {
      key: "slices",
      type: "int32",
      default: 20,
      description: "Tasks to split the manifest into; each is to take less than ten minutes",
    },
    {
      key: "jobs",
      type: "int32",
      default: 1,
      description: "Files that a worker works on at a time; more than 1 needs Dask in Blender's Python",
    },
    {
      key: "options",
      type: "string",
      default: "",
      description: "Other options of 'framelet batch', separated by spaces, as: --preset tri-2 --max-memory 8G",
    },
  ],
};

function compileJob(job) {
  const settings = job.settings;
  if (!(settings.slices >= 1)) {
    throw new Error(`The setting 'slices' is ${settings.slices}; take 1 or more.`);
  }
  const options = settings.options.split(/\s+/).filter((word) => word !== "");
  const all = author.Task("report", "blender");
  for (let number = 1; number <= settings.slices; number++) {
    const task = author.Task(`denoise-${number}-of-${settings.slices}`, "blender");
    task.addCommand(
      frameletCommand(
        ["batch", "--manifest", settings.manifest, "--out", settings.out]
          .concat(["--slice", `${number}/${settings.slices}`])
          .concat(settings.jobs > 1 ? ["--jobs", `${settings.jobs}`] : [])
          .concat(options),
      ),
    );
    job.addTask(task);
    all.addDependency(task);
  }
  all.addCommand(
    frameletCommand(["report", settings.out, "--html", path.join(settings.out, "report.html")]),
  );
  job.addTask(all);
}

function frameletCommand(words) {
  return author.Command("exec", {
    exe: "{blender}",
    // Scripts in .blend files stay off: nothing here says otherwise.
    args: ["--background", "--python-exit-code", "1", "-c", "framelet"].concat(words),
  });
}
