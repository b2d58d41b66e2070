/** A line of text that stands for a value: read by the server as one types, stored when it means something. */
import { useDebouncedCallback } from "@mantine/hooks";
import { useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { ApiProblem } from "@/api/client";
import type { Value } from "../../model/types";
import { useOpenProgram } from "../../state/context";
import { plainText, readExpression, type ReadExpression } from "./readExpression";

const PAUSE_MS = 250;

export interface Expression {
  readonly text: string;
  readonly column: number | null;
  readonly problem: string | null;
  readonly type: string;
  readonly write: (text: string) => void;
  /** Store at once what is written. */
  readonly settle: () => void;
}

interface Written {
  readonly text: string;
  /** The value as it was stored last, as JSON; another one came from outside. */
  readonly of: string;
  readonly read: ReadExpression | null;
  readonly refusal: string | null;
}

export function useExpression({
  value,
  onChange,
  step,
}: {
  value: Value | undefined;
  onChange: (value: Value) => void;
  step: string;
}): Expression {
  const { program } = useOpenProgram();
  const { t, i18n } = useTranslation();
  const key = JSON.stringify(value ?? null);
  const [written, setWritten] = useState<Written>({ text: plainText(value) ?? "", of: "", read: null, refusal: null });
  const turn = useRef(0);
  const typing = useRef(false);
  const known = useRef(plainText(value) === null ? "" : key);

  useEffect(() => {
    if (known.current === key) return;
    known.current = key;
    if (typing.current) return;
    const mine = ++turn.current;
    const plain = plainText(value);
    if (plain !== null) {
      setWritten({ text: plain, of: key, read: null, refusal: null });
      return;
    }
    readExpression(program.id, step, { value: value ?? null }).then(
      (read) => {
        if (mine === turn.current) setWritten({ text: read.text, of: key, read, refusal: null });
      },
      () => undefined,
    );
  }, [key, value, program.id, step]);

  const store = async (text: string) => {
    const mine = ++turn.current;
    typing.current = false;
    try {
      const read = await readExpression(program.id, step, { text });
      if (mine !== turn.current) return;
      setWritten((before) => ({ ...before, read, refusal: null }));
      const next = JSON.stringify(read.value);
      if (read.problem === null && next !== known.current) {
        known.current = next;
        onChange(read.value);
      }
    } catch (error) {
      const refusal = error instanceof ApiProblem ? error.detail : null;
      if (mine === turn.current) setWritten((before) => ({ ...before, refusal }));
    }
  };
  const later = useDebouncedCallback((text: string) => void store(text), { delay: PAUSE_MS, flushOnUnmount: true });
  const problem = written.read?.problem ?? null;
  const message = problem && (problem.messages[i18n.language] ?? problem.message);
  return {
    text: written.text,
    column: problem?.column ?? null,
    problem: written.refusal ?? (problem && t("expression.column", { column: problem.column, message })),
    type: written.read?.type ?? "",
    write: (text) => {
      turn.current += 1;
      typing.current = true;
      setWritten((before) => ({ ...before, text }));
      later(text);
    },
    settle: () => later.flush(),
  };
}
