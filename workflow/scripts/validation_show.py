"""Draw one check and write its section."""

from ratd import io
from ratd.figures.style import save
from ratd.jobs import Job
from ratd.validation.data import kind_of
from ratd.validation.show.report import SHOWN, section
from ratd.validation.tables import read_tables

with Job(snakemake) as job:
    check, output = snakemake.wildcards.check, snakemake.output
    table = read_tables(snakemake.input, kind_of(check))
    save(SHOWN[check].draw(table), output.pdf, output.png)
    io.write_text(output.text, section(check, SHOWN[check].tell(table), f"{check}.png"))
