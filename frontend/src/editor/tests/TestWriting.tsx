/** A test as it is written, in a form or as text, and what the parser says of it. */
import { SegmentedControl } from "@mantine/core";
import { lazy, Suspense, useEffect, useId, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import type { TestFault, TestResult } from "@/api/types";
import { textFaultWords } from "@/i18n/refusals";
import drawer from "../parts/drawer.module.css";
import { useOpenProgram } from "../state/context";
import classes from "./tests.module.css";
import { lookAt, useTestsUi } from "./tests";
import type { YamlView } from "./yamlView";

const TestForm = lazy(async () => ({ default: (await import("./TestForm")).TestForm }));

const LOOK_AFTER_MS = 400;

interface WrittenProps {
  /** The id of the test, or `new`. */
  opened: string;
  text: string;
  readOnly: boolean;
  /** What came of it as it is written here. */
  result: TestResult | null;
  onType: (text: string) => void;
}

/** The test in a form or as text, and what the parser says of it. */
export function Written({ opened, text, readOnly, result, onType }: WrittenProps) {
  const { t } = useTranslation();
  const { program } = useOpenProgram();
  const asText = useTestsUi((ui) => ui.asText);
  const fault = useFault(program.id, text, readOnly);
  const told = useId();
  return (
    <div className={classes.written}>
      {asText ? (
        <YamlText text={text} readOnly={readOnly} fault={fault} told={told} onType={onType} />
      ) : (
        <Suspense fallback={null}>
          <TestForm
            opened={opened}
            text={text}
            readOnly={readOnly}
            result={result}
            onType={onType}
            onText={() => write(true)}
          />
        </Suspense>
      )}
      <p id={told} role="status" className={classes.fault} data-wrong={fault ? true : undefined}>
        {fault ? (
          <span lang={textFaultWords(fault).lang}>{textFaultWords(fault).text}</span>
        ) : readOnly ? null : (
          t("tests.no_fault")
        )}
      </p>
    </div>
  );
}

function write(asText: boolean): void {
  useTestsUi.setState({ asText });
}

/** Whether one writes in the form or as text. */
export function Way() {
  const { t } = useTranslation();
  const asText = useTestsUi((ui) => ui.asText);
  return (
    <SegmentedControl
      size="xs"
      aria-label={t("tests.form.way")}
      data={["form", "text"].map((way) => ({ value: way, label: t(`tests.form.ways.${way}`) }))}
      value={asText ? "text" : "form"}
      onChange={(way) => write(way === "text")}
    />
  );
}

interface YamlProps {
  text: string;
  readOnly: boolean;
  fault: TestFault | null;
  /** The id of what says the fault. */
  told: string;
  onType: (text: string) => void;
}

function YamlText({ text, readOnly, fault, told, onType }: YamlProps) {
  const { t } = useTranslation();
  const place = useRef<HTMLDivElement>(null);
  const [view, setView] = useState<YamlView | null>(null);
  const typed = useRef(onType);
  const label = t("tests.text");
  useEffect(() => {
    typed.current = onType;
  }, [onType]);
  useEffect(() => {
    let opened: YamlView | undefined;
    const closing = new AbortController();
    void import("./yamlView").then(({ openYaml }) => {
      if (!place.current || closing.signal.aborted) return;
      const onText = (next: string) => typed.current(next);
      opened = openYaml(place.current, { label, describedBy: told, readOnly, onType: onText });
      setView(opened);
    });
    return () => {
      closing.abort();
      setView(null);
      opened?.destroy();
    };
  }, [label, told, readOnly]);
  useEffect(() => view?.show(text), [view, text]);
  useEffect(() => view?.mark(fault), [view, fault]);
  return <div ref={place} className={drawer.script} />;
}

/** What the parser says of a text, asked once nobody types. */
function useFault(program: string, text: string, readOnly: boolean): TestFault | null {
  const [fault, setFault] = useState<TestFault | null>(null);
  useEffect(() => {
    if (readOnly) return;
    let latest = true;
    const ask = () =>
      void lookAt(program, text).then(
        (answer) => latest && setFault(answer.fault),
        () => {}, // who cannot be asked now is asked when it is saved
      );
    const timer = setTimeout(ask, LOOK_AFTER_MS);
    return () => {
      latest = false;
      clearTimeout(timer);
    };
  }, [program, text, readOnly]);
  return fault;
}
