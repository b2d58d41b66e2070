/** A question of a run with what one answers it by; who may not answer sees that it waits. */
import { Button, Group, TextInput } from "@mantine/core";
import { CircleHelp } from "lucide-react";
import { useState, type ReactNode } from "react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { api, ApiProblem } from "@/api/client";
import type { Question, Scalar } from "@/api/types";
import { NumberField } from "@/design/NumberField";
import { unitSign } from "@/i18n/units";
import { readAnswer } from "./answer";
import styles from "./questions.module.css";

interface QuestionCardProps {
  question: Question;
  /** Whether the reader may answer. */
  allowed: boolean;
}

interface FormProps {
  question: Question;
  busy: boolean;
  onAnswer: (value: Scalar) => void;
}

function Choice({ question, busy, onAnswer }: FormProps) {
  const { t } = useTranslation();
  const { answer } = question;
  const options: [string, Scalar][] =
    answer.type === "boolean"
      ? [
          [t("run.question.yes"), true],
          [t("run.question.no"), false],
        ]
      : answer.options.map((option) => [option, option]);
  return (
    <Group gap={8}>
      {options.map(([label, value], index) => (
        <Button
          key={label}
          size="compact-md"
          disabled={busy}
          variant={index === 0 ? "filled" : "default"}
          onClick={() => onAnswer(value)}
        >
          {label}
        </Button>
      ))}
    </Group>
  );
}

function useRange({ answer }: Question): string {
  const { t } = useTranslation();
  const { minimum, maximum } = answer;
  const unit = answer.unit ? ` ${unitSign(answer.unit)}` : "";
  if (minimum !== null && maximum !== null) return t("run.question.range", { minimum, maximum, unit });
  if (minimum !== null) return t("run.question.atLeast", { minimum, unit });
  return maximum === null ? unit.trim() : t("run.question.atMost", { maximum, unit });
}

function Field(props: FormProps) {
  const { t } = useTranslation();
  const { question, busy, onAnswer } = props;
  const [typed, setTyped] = useState<string | number>("");
  const [problem, setProblem] = useState<string | null>(null);
  const range = useRange(question);
  const send = () => {
    const read = readAnswer(question.answer, typed);
    if ("value" in read) return onAnswer(read.value);
    setProblem(t(`run.question.problem.${read.problem}`, { range }));
  };
  const common = { "aria-label": question.text, error: problem, size: "sm" as const, className: styles.field };
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        send();
      }}
    >
      <Group gap={8} align="flex-start">
        {question.answer.type === "number" ? (
          <NumberField
            {...common}
            value={typed}
            onChange={setTyped}
            description={range || undefined}
            inputWrapperOrder={["input", "description", "error"]}
          />
        ) : (
          <TextInput {...common} value={typed} maxLength={500} onChange={(event) => setTyped(event.target.value)} />
        )}
        <Button type="submit" size="sm" disabled={busy}>
          {t("run.question.send")}
        </Button>
      </Group>
    </form>
  );
}

function Answered({ question }: { question: Question }): ReactNode {
  const { t } = useTranslation();
  const { value } = question;
  const unit = question.answer.unit ? ` ${unitSign(question.answer.unit)}` : "";
  const words =
    typeof value === "boolean" ? t(value ? "run.question.yes" : "run.question.no") : `${value ?? ""}${unit}`;
  if (question.state === "withdrawn") return <p className={styles.note}>{t("run.question.withdrawn")}</p>;
  return <p className={styles.note}>{t("run.question.answeredBy", { name: question.answered_by, answer: words })}</p>;
}

export function QuestionCard({ question, allowed }: QuestionCardProps) {
  const { t } = useTranslation();
  const [busy, setBusy] = useState(false);
  const [problem, setProblem] = useState<string | null>(null);
  const onAnswer = (value: Scalar) => {
    setBusy(true);
    api
      .post(`/questions/${question.id}/answer`, { value })
      .then(() => setProblem(null))
      .catch((error: unknown) => {
        if (!(error instanceof ApiProblem)) throw error;
        setProblem(error.detail);
        setBusy(false);
      });
  };
  const Form = ["boolean", "choice"].includes(question.answer.type) ? Choice : Field;
  const open = question.state === "open";
  return (
    <section className={styles.card} data-state={question.state} aria-label={t("run.question.title")}>
      <p className={styles.head}>
        <CircleHelp size={15} aria-hidden />
        <Link to={`/runs/${question.run}`}>
          {question.program.name} · {t("run.title", { number: question.run_number })}
        </Link>
      </p>
      <p className={styles.text}>{question.text}</p>
      {open && allowed ? <Form question={question} busy={busy} onAnswer={onAnswer} /> : null}
      {open && !allowed ? <p className={styles.note}>{t("run.question.waits")}</p> : null}
      {open ? null : <Answered question={question} />}
      {problem && open ? (
        <p className={styles.problem} role="alert">
          {problem}
        </p>
      ) : null}
    </section>
  );
}
