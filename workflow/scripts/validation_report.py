"""Write docs/validation.md and draw its figures."""

import shutil
from pathlib import Path

from ratd import io
from ratd.figures.style import save
from ratd.jobs import Job
from ratd.validation.data import check_table, is_whole, older_section, read_pieces
from ratd.validation.show.report import SHOWN, report

with Job(snakemake) as job:
    output, settings = snakemake.output, job.settings
    folder, checks = settings["folder"], settings["checks"]
    text = report(folder, checks, Path(output.figures[0]).parent.name, settings["command"])
    for check, picture in zip(checks, output.figures, strict=True):
        if is_whole(read_pieces(folder, check), checks[check]):
            save(SHOWN[check].draw(check_table(folder, check)), picture)
        else:
            with io.atomic(picture) as temporary:
                shutil.copyfile(older_section(folder, check)[1], temporary)
    io.write_text(output.text, text)
