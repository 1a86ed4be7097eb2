"""Errors of the operating system: by number, name and words, and what they mean on each kind of object."""

from __future__ import annotations

import errno
import os

import pytest

from cellc.tools.diagnose.diagnose import diagnose
from cellc.tools.diagnose.os_errors import os_errors
from cellc.tools.diagnose.symptoms import knowledge, system_errors

SYMPTOMS = {symptom.name for layer in knowledge() for symptom in layer.symptoms}


@pytest.mark.parametrize(
    ("text", "kind", "symptom"),
    [
        ("could not open /dev/ttyUSB0: [Errno 13]", "serial", "a USB or serial device changes its name"),
        ("Unable to open USB port: /dev/motors, errno: (2) No such file or directory", "serial", "a USB or serial"),
        ("open /dev/video0: EACCES", "camera", "the camera is not found"),
        ("pthread_setschedparam: Operation not permitted", "scheduling", "real-time scheduling is refused"),
        ("shm_open fastrtps_port7412: Permission denied", "memory", "the shared memory of the middleware fails"),
        ("Failed to open: /dev/EtherCAT0: Permission denied", "bus", "a field bus loses frames"),
        ("file not found: [Errno 2] No such file or directory: 'xacro'", "", "a file, package or"),
        ("libx.so: No such file or directory", "library", "a shared library is missing"),
        ("connect to 192.168.1.5: os error 111", "network", "the host cannot reach the device"),
        ("write: No buffer space available", "", "a field bus loses frames"),
        ("sendto socket: No buffer space available", "network", "big messages are lost"),
    ],
)
def test_error_belongs_to_a_symptom_by_its_number_and_its_object(text: str, kind: str, symptom: str) -> None:
    (meaning, *_) = os_errors(text)
    assert (meaning.symptom.startswith(symptom), meaning.kind) == (True, kind)


def test_words_that_are_parts_of_others_are_no_errors() -> None:
    assert os_errors("the aeiou robot of epipen makers has 13 joints") == ()


def test_numbers_and_texts_are_those_of_the_system() -> None:
    for error in system_errors().errors:
        assert [errno.errorcode[number] for number in error.numbers] == list(error.names)
        assert {os.strerror(number).casefold() for number in error.numbers} & set(error.texts)


def test_every_meaning_is_a_symptom_and_of_a_known_kind() -> None:
    for error in system_errors().errors:
        assert set(error.means.values()) <= SYMPTOMS
        assert set(error.means) <= {"other", *system_errors().kinds}
        assert "other" in error.means


def test_error_and_object_are_told_as_evidence() -> None:
    (suspicion, *_) = diagnose("open /dev/ttyACM0: Permission denied", None).suspicions
    assert suspicion.evidence == ("error `permission denied`", "object `serial`")
    assert os_errors("read: errno 13")[0].error == "EACCES"
