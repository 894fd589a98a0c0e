"""How this package runs OpenCV: on one thread, saying nothing of its own."""

import os
from collections.abc import Mapping

import cv2

ONE_THREAD: Mapping[str, str] = {
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "OPENCV_FFMPEG_LOGLEVEL": "-8",
}
"""Environment for a process that is to compute on one thread; linear algebra reads it when it is loaded."""


def one_thread() -> None:
    """Keeps OpenCV to the calling thread."""
    cv2.setNumThreads(1)


def quiet() -> None:
    """Silences OpenCV and its FFmpeg: what fails is reported by us, once."""
    os.environ["OPENCV_FFMPEG_LOGLEVEL"] = ONE_THREAD["OPENCV_FFMPEG_LOGLEVEL"]
    cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)
