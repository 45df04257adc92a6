#!/bin/sh
# Installs nvcc from pinned wheels into the folder $1, unless it is there already, and prints its path.
set -eu
folder=$1
nvcc=$(ls "$folder"/lib/python3*/site-packages/nvidia/cu13/bin/nvcc 2>/dev/null || true)
if [ -z "$nvcc" ]; then
  /usr/bin/python3 -m venv "$folder"
  "$folder"/bin/pip install -q --disable-pip-version-check 'nvidia-cuda-nvcc==13.0.*' \
    'nvidia-cuda-runtime==13.0.*' 'nvidia-cuda-crt==13.0.*' 'nvidia-cuda-cccl==13.0.*' \
    'nvidia-nvvm==13.0.*' >&2
  nvcc=$(ls "$folder"/lib/python3*/site-packages/nvidia/cu13/bin/nvcc)
  ln -sfn lib "${nvcc%/bin/nvcc}"/lib64  # where nvcc looks for the runtime
fi
(cd "${nvcc%/nvcc}" && echo "$PWD/nvcc")
