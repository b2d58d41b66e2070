/** The tests beside a program: how each came out, running them, one of them to write, and what none of them takes. */
import { Button, Menu, NativeSelect } from "@mantine/core";
import { FlaskConical, FolderDown, FolderUp, Play, Plus, X } from "lucide-react";
import { useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { ApiProblem } from "@/api/client";
import { useVersions } from "@/api/queries";
import { mayOperate } from "@/api/roles";
import type { ProgramTests, TestRun } from "@/api/types";
import { useNow } from "@/design/useNow";
import { formatAgo, formatSpan } from "@/i18n/format";
import { reasonWords } from "@/i18n/reasons";
import { LoadProblem, problemText } from "@/shell/LoadProblem";
import { useOpenProgram } from "../state/context";
import { say } from "../state/ui";
import { ChangesList } from "./ChangesList";
import { CoverageList } from "./CoverageList";
import { TestDetail } from "./TestDetail";
import { TestList } from "./TestList";
import classes from "./tests.module.css";
import { tell, useRun } from "./useRun";
import {
  exportPath,
  keepDraft,
  NEW,
  openTest,
  resetTests,
  useTestProgress,
  useTesting,
  useTests,
  useTestsUi,
} from "./tests";

export function TestsPanel() {
  const { program } = useOpenProgram();
  const tests = useTests(program.id);
  const opened = useTestsUi((ui) => ui.opened);
  useEffect(() => {
    useTestsUi.setState({ shown: true });
    return () => useTestsUi.setState({ shown: false });
  }, []);
  useForgetting(program.id);
  if (!tests.data) return tests.error ? <LoadProblem error={tests.error} again={() => void tests.refetch()} /> : null;
  const test = tests.data.tests.find(({ id }) => id === opened);
  return (
    <div className={classes.panel} data-detail={opened !== null || undefined}>
      <div className={classes.left}>
        <Head tests={tests.data} />
        <TestList tests={tests.data} />
      </div>
      <div className={classes.right}>
        {opened === null ? (
          <>
            <CoverageList tests={tests.data} />
            <ChangesList tests={tests.data} />
          </>
        ) : (
          <TestDetail key={opened} opened={opened} test={test} most={tests.data.most} />
        )}
      </div>
    </div>
  );
}

let known = "";

/** What was written for another program is not for this one. */
function useForgetting(program: string): void {
  useEffect(() => {
    if (known !== program) resetTests();
    known = program;
  }, [program]);
}

function Head({ tests }: { tests: ProgramTests }) {
  const { site, canEdit } = useOpenProgram();
  const [version, setVersion] = useState<number | undefined>();
  const under = tests.under_way[0];
  return (
    <div className={classes.head}>
      {under ? <UnderWay key={under.id} run={under} /> : <Summary tests={tests} />}
      <div className={classes.acts}>
        {canEdit ? <NewTest /> : null}
        <span className={classes.files}>
          {canEdit ? <BringIn /> : null}
          {tests.tests.length > 0 ? <Export /> : null}
        </span>
        {mayOperate(site.role) && tests.tests.length > 0 ? (
          <>
            <VersionChoice version={version} onChange={setVersion} />
            <SeedsChoice />
            <RunAll version={version} busy={under !== undefined} />
          </>
        ) : null}
      </div>
    </div>
  );
}

function Summary({ tests }: { tests: ProgramTests }) {
  const { t } = useTranslation();
  const now = useNow(30_000);
  const last = tests.last;
  const results = tests.tests.flatMap(({ result }) => result ?? []);
  const passed = results.filter(({ status }) => status === "passed").length;
  const outdated = results.filter(({ stale }) => stale !== null).length;
  const facts = [
    results.length > 0 ? t("tests.pass", { passed, count: tests.tests.length }) : t("tests.never_run"),
    outdated > 0 ? t("tests.outdated", { count: outdated }) : "",
    ...(last?.status === "done" ? [whereOf(last, t), last.ended_at ? formatAgo(last.ended_at, now) : ""] : []),
  ];
  if (tests.tests.length === 0) return <span />;
  return (
    <p className={classes.summary} role="status">
      <strong>{facts[0]}</strong>
      <span>{facts.slice(1).filter(Boolean).join(", ")}</span>
      {last?.status === "cancelled" ? <span>{t("tests.cancelled")}</span> : null}
      {last?.status === "failed" ? (
        <span>{t("tests.run_failed", { reason: reasonWords(last.cause, last.reason) })}</span>
      ) : null}
    </p>
  );
}

function whereOf(run: TestRun, t: (key: string, values?: Record<string, unknown>) => string): string {
  return run.number === null ? t("tests.on_draft") : t("tests.on_version", { number: run.number });
}

/** How far the tests are that were begun first, and a way to end them. */
function UnderWay({ run }: { run: TestRun }) {
  const { t } = useTranslation();
  const { program, site } = useOpenProgram();
  const act = useTesting(program.id);
  const rehearsal = useTestProgress(run.rehearsal).data;
  const course = rehearsal?.course;
  const words = course
    ? `${t(run.seeds > 0 || run.tries_changes ? "tests.rehearsal_of" : "tests.under_way", { at: Math.min(course.steps_done + 1, course.steps), count: course.steps })}, ${t("tests.virtual", { time: formatSpan(course.virtual_s) })}`
    : rehearsal?.place
      ? t("tests.waits", { place: rehearsal.place })
      : t("tests.waits_soon");
  return (
    <div className={classes.underWay}>
      <p role="status">{words}</p>
      <progress aria-label={words} max={1} value={rehearsal?.progress ?? 0} />
      {(mayOperate(site.role) || run.mine) && run.rehearsal ? (
        <Button
          size="compact-xs"
          variant="default"
          leftSection={<X size={12} aria-hidden="true" />}
          onClick={() => void act.cancel(run.rehearsal ?? "").catch(tell(t))}
        >
          {t("tests.cancel")}
        </Button>
      ) : null}
    </div>
  );
}

function VersionChoice({
  version,
  onChange,
}: {
  version: number | undefined;
  onChange: (to: number | undefined) => void;
}) {
  const { t } = useTranslation();
  const { program } = useOpenProgram();
  const versions = useVersions(program.id).data?.pages.flatMap(({ items }) => items) ?? [];
  const data = [
    { value: "", label: t("tests.draft") },
    ...versions.map(({ number, name }) => ({
      value: String(number),
      label: name ? t("tests.version_named", { number, name }) : t("tests.version", { number }),
    })),
  ];
  return (
    <NativeSelect
      size="xs"
      className={classes.version}
      aria-label={t("tests.run_on")}
      data={data}
      value={version === undefined ? "" : String(version)}
      onChange={(event) => onChange(event.currentTarget.value === "" ? undefined : Number(event.currentTarget.value))}
    />
  );
}

const SEEDS = [0, 20, 100];

function SeedsChoice() {
  const { t } = useTranslation();
  const seeds = useTestsUi((ui) => ui.seeds);
  const words = (count: number) => (count === 0 ? t("tests.seeds_own") : t("tests.seeds_each", { count }));
  return (
    <NativeSelect
      size="xs"
      aria-label={t("tests.seeds")}
      data={SEEDS.map((count) => ({ value: String(count), label: words(count) }))}
      value={String(seeds)}
      onChange={(event) => useTestsUi.setState({ seeds: Number(event.currentTarget.value) })}
    />
  );
}

function RunAll({ version, busy }: { version: number | undefined; busy: boolean }) {
  const { t } = useTranslation();
  const run = useRun();
  const seeds = useTestsUi((ui) => ui.seeds);
  return (
    <Button
      size="compact-sm"
      leftSection={<Play size={13} aria-hidden="true" />}
      loading={run.isPending}
      disabled={busy}
      onClick={() => run.start({ ...(version === undefined ? {} : { version }), seeds })}
    >
      {t("tests.run_all")}
    </Button>
  );
}

function NewTest() {
  const { t } = useTranslation();
  const { program } = useOpenProgram();
  const act = useTesting(program.id);
  const begin = (of: "nothing" | "rehearsal") =>
    act.first(of).then((first) => {
      if (of === "rehearsal" && !first.of_rehearsal) say(t("tests.no_rehearsal"));
      keepDraft(NEW, { id: null, text: first.text, tag: "" });
      openTest(NEW);
    }, tell(t));
  return (
    <Menu position="top-start" withinPortal>
      <Menu.Target>
        <Button size="compact-sm" variant="default" leftSection={<Plus size={13} aria-hidden="true" />}>
          {t("tests.new")}
        </Button>
      </Menu.Target>
      <Menu.Dropdown>
        <Menu.Item leftSection={<FlaskConical size={14} aria-hidden="true" />} onClick={() => void begin("nothing")}>
          {t("tests.new_empty")}
        </Menu.Item>
        <Menu.Item leftSection={<Play size={14} aria-hidden="true" />} onClick={() => void begin("rehearsal")}>
          {t("tests.new_rehearsal")}
        </Menu.Item>
      </Menu.Dropdown>
    </Menu>
  );
}

function BringIn() {
  const { t } = useTranslation();
  const { program } = useOpenProgram();
  const act = useTesting(program.id);
  const file = useRef<HTMLInputElement>(null);
  const bring = async (chosen: File | undefined) => {
    if (!chosen) return;
    try {
      const made = await act.bringIn(await chosen.text());
      say(t("tests.imported", { count: made.length }));
    } catch (problem) {
      const taken = problem instanceof ApiProblem && problem.code === "test_name_taken";
      say(taken ? t("tests.refusal.test_name_taken") : problemText(problem, t("shell.problem.screen")));
    }
    if (file.current) file.current.value = "";
  };
  return (
    <>
      <input
        ref={file}
        type="file"
        hidden
        accept=".yaml,.yml"
        aria-label={t("tests.import")}
        onChange={(event) => void bring(event.currentTarget.files?.[0])}
      />
      <Button
        size="compact-sm"
        variant="default"
        leftSection={<FolderUp size={13} aria-hidden="true" />}
        onClick={() => file.current?.click()}
      >
        {t("tests.import")}
      </Button>
    </>
  );
}

function Export() {
  const { t } = useTranslation();
  const { program } = useOpenProgram();
  return (
    <Button
      size="compact-sm"
      variant="default"
      component="a"
      href={exportPath(program.id)}
      download
      leftSection={<FolderDown size={13} aria-hidden="true" />}
    >
      {t("tests.export")}
    </Button>
  );
}
