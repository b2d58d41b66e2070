/** One test: what it says, and what came of it. */
import { Button } from "@mantine/core";
import { ArrowLeft, Check, Play, Save, Trash2, X } from "lucide-react";
import { useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { ApiProblem } from "@/api/client";
import { mayOperate } from "@/api/roles";
import type { ProgramTest, TestOdds, TestResult } from "@/api/types";
import { formatNumber, formatSpan } from "@/i18n/format";
import { textFaultWords } from "@/i18n/refusals";
import { LoadProblem, problemText } from "@/shell/LoadProblem";
import { useOpenProgram } from "../state/context";
import { say } from "../state/ui";
import { formatShare } from "./odds";
import { expectedWords, seenWords } from "@/program/words/testSentences";
import classes from "./tests.module.css";
import { carryForm, keepDraft, openTest, readTest, useTesting, useTestsUi, useTestText } from "./tests";
import { Status, staleWords } from "./TestList";
import { Way, Written } from "./TestWriting";
import { useRun } from "./useRun";

interface DetailProps {
  /** The id of a test, or `new`. */
  opened: string;
  test: ProgramTest | undefined;
  most: number;
}

export function TestDetail({ opened, test, most }: DetailProps) {
  const { t } = useTranslation();
  const { program, canEdit } = useOpenProgram();
  const saved = useTestText(program.id, test);
  const draft = useTestsUi((ui) => ui.drafts[opened]);
  const text = draft?.text ?? saved.data?.text;
  const type = (next: string) => {
    if (next === saved.data?.text && (draft === undefined || draft.tag === saved.data.tag)) keepDraft(opened, null);
    else keepDraft(opened, { id: draft?.id ?? test?.id ?? null, text: next, tag: draft?.tag ?? saved.data?.tag ?? "" });
  };
  return (
    <section className={classes.detail} aria-label={test?.name ?? t("tests.new")}>
      <DetailHead opened={opened} test={test} most={most} />
      {saved.error ? <LoadProblem error={saved.error} again={() => void saved.refetch()} /> : null}
      {text === undefined ? null : (
        <div className={classes.halves}>
          <Written
            opened={opened}
            text={text}
            readOnly={!canEdit}
            result={draft ? null : (test?.result ?? null)}
            onType={type}
          />
          {test?.result ? <Result result={test.result} /> : null}
        </div>
      )}
    </section>
  );
}

function DetailHead({ opened, test, most }: DetailProps) {
  const { t } = useTranslation();
  const { site } = useOpenProgram();
  const draft = useTestsUi((ui) => ui.drafts[opened]);
  const run = useRun();
  const writing = useWriting(opened, test, most);
  return (
    <>
      <div className={classes.detailHead}>
        <Button
          size="compact-sm"
          variant="subtle"
          leftSection={<ArrowLeft size={14} aria-hidden="true" />}
          onClick={() => openTest(null)}
        >
          {t("tests.back")}
        </Button>
        <h2>{test?.name ?? t("tests.new")}</h2>
        <Way />
        <div className={classes.acts}>
          {draft ? (
            <>
              <Button size="compact-sm" variant="default" onClick={writing.discard}>
                {t("tests.discard")}
              </Button>
              <Button
                size="compact-sm"
                leftSection={<Save size={13} aria-hidden="true" />}
                loading={writing.isPending}
                onClick={() => writing.save()}
              >
                {t("tests.save")}
              </Button>
            </>
          ) : null}
          {test && !draft && mayOperate(site.role) ? (
            <Button
              size="compact-sm"
              variant="default"
              leftSection={<Play size={13} aria-hidden="true" />}
              loading={run.isPending}
              onClick={() => run.start({ tests: [test.id], seeds: useTestsUi.getState().seeds })}
            >
              {t("tests.run_this")}
            </Button>
          ) : null}
          {test && !draft ? <Delete test={test} onDelete={writing.remove} /> : null}
        </div>
      </div>
      <Meanwhile opened={opened} test={test} writing={writing} />
      {writing.problem ? (
        <p role="alert" className={classes.refusal}>
          {writing.problem}
        </p>
      ) : null}
    </>
  );
}

type Writing = ReturnType<typeof useWriting>;

/** Saving and deleting; a refusal stays beside the words that it is about. */
function useWriting(opened: string, test: ProgramTest | undefined, most: number) {
  const { t } = useTranslation();
  const { program } = useOpenProgram();
  const act = useTesting(program.id);
  const [problem, setProblem] = useState("");
  const refuse = (error: unknown) => {
    const code = error instanceof ApiProblem ? error.code : "";
    if (code === "test_name_taken" || code === "tests_full") setProblem(t(`tests.refusal.${code}`, { most }));
    else if (code !== "changed") setProblem(problemText(error, t("shell.problem.screen")));
  };
  const save = (tag?: string) => {
    const draft = useTestsUi.getState().drafts[opened];
    if (!draft) return;
    setProblem("");
    const written = test ? act.write(test.id, draft.text, tag ?? draft.tag) : act.add(draft.text);
    void written.then((made) => {
      const now = useTestsUi.getState().drafts[opened];
      // What was typed while it was saved is of what is saved now.
      keepDraft(opened, null);
      carryForm(opened, draft.text, made);
      if (now && now.text !== draft.text) keepDraft(made.id, { id: made.id, text: now.text, tag: made.tag });
      openTest(made.id);
      say(t("tests.saved"));
    }, refuse);
  };
  const discard = () => {
    keepDraft(opened, null);
    setProblem("");
    if (!test) openTest(null);
  };
  const remove = () => {
    if (test) void act.remove(test.id, test.tag).then(() => openTest(null), refuse);
  };
  return { save, discard, remove, problem, isPending: act.isPending };
}

/** Somebody else has written or deleted what one is writing: nothing is lost, and one decides. */
function Meanwhile({ opened, test, writing }: { opened: string; test: ProgramTest | undefined; writing: Writing }) {
  const { t } = useTranslation();
  const { program } = useOpenProgram();
  const draft = useTestsUi((ui) => ui.drafts[opened]);
  if (!draft?.id) return null;
  if (!test)
    return (
      <div role="alert" className={classes.meanwhile}>
        <p>{t("tests.gone")}</p>
        <Button size="compact-xs" variant="default" onClick={() => writing.save()}>
          {t("tests.as_new")}
        </Button>
      </div>
    );
  if (test.tag === draft.tag) return null;
  const showTheirs = () =>
    void readTest(program.id, test.id).then((theirs) => {
      const text = `${draft.text.trimEnd()}\n\n${theirs.text.replace(/^/gm, "# ").trimEnd()}\n`;
      keepDraft(opened, { id: test.id, text, tag: theirs.tag });
    });
  return (
    <div role="alert" className={classes.meanwhile}>
      <p>{t("tests.meanwhile")}</p>
      <Button size="compact-xs" variant="default" onClick={showTheirs}>
        {t("tests.theirs")}
      </Button>
      <Button size="compact-xs" variant="default" onClick={() => writing.save(test.tag)}>
        {t("tests.over_theirs")}
      </Button>
    </div>
  );
}

/** Deleting asks once more in the same place. */
function Delete({ test, onDelete }: { test: ProgramTest; onDelete: () => void }) {
  const { t } = useTranslation();
  const { canEdit } = useOpenProgram();
  const [sure, setSure] = useState(false);
  useEffect(() => setSure(false), [test.id]);
  if (!canEdit) return null;
  return (
    <Button
      size="compact-sm"
      variant="default"
      color="red"
      leftSection={<Trash2 size={13} aria-hidden="true" />}
      onBlur={() => setSure(false)}
      onClick={() => (sure ? onDelete() : setSure(true))}
    >
      {t(sure ? "tests.delete_sure" : "tests.delete")}
    </Button>
  );
}

function Result({ result }: { result: TestResult }) {
  const { t } = useTranslation();
  const facts = [
    result.number === null ? t("tests.on_draft") : t("tests.on_version", { number: result.number }),
    result.duration_s > 0 ? formatSpan(result.duration_s) : "",
    t("tests.seed", { seed: result.seed }),
    staleWords(result, t),
  ];
  return (
    // oxlint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- it scrolls, so the keyboard has to come to it
    <section className={classes.result} aria-label={t("tests.result")} tabIndex={0}>
      <p>
        <Status status={result.status} /> {facts.filter(Boolean).join(", ")}
      </p>
      {result.status === "stopped" ? <p>{t("tests.stopped_why")}</p> : null}
      {result.why ? <p lang={textFaultWords(result).lang}>{textFaultWords(result).text}</p> : null}
      <ul className={classes.expectations}>
        {result.expectations.map((each, index) => (
          <li key={index} data-ok={each.ok || undefined}>
            {each.ok ? (
              <Check size={14} aria-label={t("tests.holds")} />
            ) : (
              <X size={14} aria-label={t("tests.fails")} />
            )}
            <span lang={expectedWords(each, t).lang}>{expectedWords(each, t).text}</span>
            {each.ok ? null : (
              <small lang={seenWords(each, t).lang}>{t("tests.saw", { what: seenWords(each, t).text })}</small>
            )}
            <Measured span={result.odds?.figures[index] ?? null} inTime={each.kind === "within_s"} />
          </li>
        ))}
      </ul>
      {result.odds && result.odds.seeds > 0 ? <OddsWords odds={result.odds} /> : null}
      {result.errors.length > 0 ? (
        <>
          <h3>{t("tests.errors")}</h3>
          <ul lang="en">
            {result.errors.map((each, index) => (
              <li key={index}>{each}</li>
            ))}
          </ul>
        </>
      ) : null}
    </section>
  );
}

/** What an expectation has measured with many seeds. */
function Measured({ span, inTime }: { span: TestOdds["figures"][number]; inTime: boolean }) {
  const { t } = useTranslation();
  if (!span || span.least === span.most) return null;
  const [least, most] = [span.least, span.most].map((value) => (inTime ? formatSpan(value) : formatNumber(value, 1)));
  return <small>{t("tests.odds_figure", { least, most })}</small>;
}

function OddsWords({ odds }: { odds: TestOdds }) {
  const { t } = useTranslation();
  const { seeds, asked, failed, failing, took_s: took } = odds;
  const shares = { share: formatShare(failed / seeds), low: formatShare(odds.low), high: formatShare(odds.high) };
  const listed = failing.join(", ") + (failed > failing.length ? ", …" : "");
  return (
    <div className={classes.oddsWords}>
      <p>{t("tests.odds_words", { failed, seeds, ...shares })}</p>
      {seeds < asked ? <p>{t("tests.odds_cut", { seeds, asked })}</p> : null}
      {failing.length > 0 ? <p>{t("tests.odds_failing", { seeds: listed })}</p> : null}
      {took ? <p>{t("tests.odds_took", { median: formatSpan(took.median), p95: formatSpan(took.p95) })}</p> : null}
    </div>
  );
}
