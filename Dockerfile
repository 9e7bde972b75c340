# A container with everything pinned: the README's first command, in two steps.
#
#     docker build -t ratd .
#     docker run --rm -v "$PWD/results:/ratd/results" ratd
#
# Apptainer takes it as well: `apptainer build ratd.sif docker-daemon://ratd:latest`.
FROM python:3.11-slim
WORKDIR /ratd
COPY . .
RUN python3 -m venv .venv && .venv/bin/pip install --no-cache-dir -r environment.txt
ENV PATH=/ratd/.venv/bin:$PATH
CMD ["snakemake", "--cores", "2", "all", "compression", "collision", "--configfile", "config/quick.yaml"]
