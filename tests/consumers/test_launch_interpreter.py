"""The interpreter of launch files itself: what ros2 launch answers to small files."""

from __future__ import annotations

import pytest

from tests.consumers.launch_interpreter import Launch
from tests.consumers.launch_text import LaunchError


def launched(actions: str, **given: str) -> Launch:
    texts = {"a.launch.xml": f"<launch>{actions}</launch>", "file.yaml": "x", "b.launch.xml": "<launch><arg name='b'/>"}
    texts["b.launch.xml"] += "</launch>"
    return Launch("pkg", texts, given).run("a.launch.xml")


def test_default_is_taken_where_nothing_is_given_and_the_given_value_wins() -> None:
    arg = '<arg name="a" default="1"/><node pkg="p" exec="e" name="n$(var a)"/>'
    assert launched(arg).processes[0].name == "n1"
    assert launched(arg, a="2").processes[0].name == "n2"


def test_quotes_hold_nested_substitutions_together() -> None:
    arg = '<arg name="a" default="real"/>'
    node = "<node pkg='p' exec='e' if=\"$(eval &quot;'$(var a)' == 'real'&quot;)\"/>"
    assert len(launched(arg + node).processes) == 1
    assert not launched(arg + node, a="mock").processes


def test_namespaces_add_up_and_end_with_their_group() -> None:
    node = '<node pkg="p" exec="e" namespace="b"/>'
    actions = f'<group><push_ros_namespace namespace="a"/>{node}</group>{node}'
    assert [process.namespace for process in launched(actions).processes] == ["/a/b", "/b"]


@pytest.mark.parametrize(
    ("actions", "message"),
    [
        ('<arg name="a"/>', "required launch argument"),
        ('<arg name="a" default="c"><choice value="b"/></arg>', "not one of"),
        ('<include file="$(find-pkg-share pkg)/b.launch.xml"/>', "missing required argument 'b'"),
        ('<include file="$(find-pkg-share pkg)/c.launch.xml"/>', "there is no file"),
        ('<include file="$(find-pkg-share other)/b.launch.xml"/>', "there is no file"),
        (
            '<arg name="b" default="1"/><include file="$(find-pkg-share pkg)/b.launch.xml"/>',
            "missing required argument 'b'",
        ),
        ('<node pkg="p" exec="e" if="yes"/>', "neither true nor false"),
        ('<node pkg="p" exec="e" name="$(var x)"/>', "does not exist"),
        ('<node pkg="p" exec="e" nam="x"/>', "unknown"),
        ('<node pkg="p" exec="e"><parm name="x"/></node>', "unknown"),
        ('<node pkg="p" exec="e" output="loud"/>', "unknown output"),
        ('<node pkg="p" exec="e"><param from="$(find-pkg-share pkg)/none.yaml"/></node>', "there is no file"),
        ('<node pkg="p" exec="$(command \'rm -r x\')"/>', "unknown command"),
        ('<node pkg="p" exec="$(eval \'__import__(1)\')"/>', "cannot evaluate"),
        ('<node pkg="p" exec="$(var x"/>', "not closed"),
        ("<nod/>", "unknown action"),
        ('<executable name="a" command="b"/>', "unknown"),
        ('<executable name="a" cmd="bash $(find-pkg-share pkg)/none.bash"/>', "there is no file"),
    ],
)
def test_what_launch_refuses_is_refused(actions: str, message: str) -> None:
    with pytest.raises(LaunchError, match=message):
        launched(actions)


def test_include_takes_what_it_is_given_and_holds_it_against_the_choices() -> None:
    include = '<include file="$(find-pkg-share pkg)/b.launch.xml"><arg name="b" value="$(var a)"/></include>'
    assert launched('<arg name="a" default="1"/>' + include).configurations["b"] == "1"


def test_commands_and_prefixes_are_split_into_words() -> None:
    actions = (
        '<executable name="a" cmd="bash $(find-pkg-share pkg)/file.yaml step" output="both"/>'
        '<node pkg="p" exec="e" launch-prefix="bash $(find-pkg-share pkg)/file.yaml other"/>'
    )
    run = launched(actions)
    assert [(command.name, command.words) for command in run.commands] == [("a", ("bash", "file.yaml", "step"))]
    assert run.processes[0].prefix == ("bash", "file.yaml", "other")


def test_parameters_remaps_and_arguments_are_listed() -> None:
    node = (
        '<node pkg="p" exec="e" args="a -c /cm" ros_args="--enclave /x" respawn="true">'
        '<param from="$(find-pkg-share pkg)/file.yaml"/>'
        '<param name="d" value="$(command \'cat $(find-pkg-share pkg)/file.yaml\')" type="str"/>'
        '<remap from="r" to="/s"/></node>'
    )
    (process,) = launched(node).processes
    assert process.files == ("file.yaml",)
    assert process.values == {"d": ("x", "str")}
    assert process.remaps == {"r": "/s"}
    assert process.arguments == ("a", "-c", "/cm")
    assert process.ros_arguments == ("--enclave", "/x")
    assert process.respawn
