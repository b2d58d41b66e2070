/** Where a provider sends the browser back to: what it gave along is taken out of the address and finishes the sign-in. */
import { Button, TextInput } from "@mantine/core";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { CircleAlert } from "lucide-react";
import { useEffect, useRef, useState, type FormEvent } from "react";
import { useTranslation } from "react-i18next";
import { Link, useNavigate, useParams } from "react-router-dom";
import { api, ApiProblem, rememberCsrf } from "@/api/client";
import { keys, useMe } from "@/api/queries";
import type { SignedOn, SignOnAnswer } from "@/api/types";
import { EmptyState } from "@/design/EmptyState";
import { Logo } from "@/design/Logo";
import { Panel } from "@/design/Panel";
import { takeKeyboard } from "@/design/takeKeyboard";
import { useTitle } from "@/shell/useTitle";
import { problemText, Waiting } from "@/shell/LoadProblem";
import { useProviders } from "./providers";
import { safeNext } from "./safeNext";
import styles from "./SignInPage.module.css";

/** What the provider gave along; `error` and `code` exclude each other. */
function readAnswer(): SignOnAnswer {
  const given = new URLSearchParams(location.search);
  const get = (name: string) => given.get(name) ?? "";
  return { state: get("state"), code: get("code"), iss: get("iss"), error: get("error"), factor: "" };
}

function useFinish(provider: string) {
  const queries = useQueryClient();
  const navigate = useNavigate();
  return useMutation({
    mutationFn: (answer: SignOnAnswer) =>
      api.post<SignedOn>(`/sign-in/providers/${encodeURIComponent(provider)}/finish`, answer),
    onSuccess: async ({ next, ...me }) => {
      rememberCsrf(me.csrf);
      queries.clear();
      queries.setQueryData(keys.me, me);
      await navigate(safeNext(next), { replace: true });
    },
  });
}

function AskFactor({
  title,
  error,
  busy,
  send,
}: {
  title: string;
  error: ApiProblem;
  busy: boolean;
  send: (factor: string) => void;
}) {
  const { t } = useTranslation();
  const [code, setCode] = useState("");
  const submit = (event: FormEvent) => {
    event.preventDefault();
    send(code);
  };
  return (
    <Panel className={styles.card} floating>
      <div className={styles.brand}>
        <Logo size={34} />
        <div>
          <h1>{t("signOn.factor")}</h1>
          <p>{t("signOn.factorText", { title })}</p>
        </div>
      </div>
      <form className={styles.form} onSubmit={submit}>
        <TextInput
          label={t("factor.signIn")}
          description={t("factor.signInHint")}
          autoComplete="one-time-code"
          ref={takeKeyboard}
          required
          withAsterisk={false}
          maxLength={40}
          value={code}
          error={error.code === "wrong_code"}
          onChange={(event) => setCode(event.target.value)}
        />
        <p>{t("factor.lost")}</p>
        {error.code === "second_factor_needed" ? null : (
          <p className={styles.refused} role="alert">
            <CircleAlert size={16} aria-hidden="true" />
            {error.message}
          </p>
        )}
        <Button type="submit" size="md" loading={busy} disabled={!code}>
          {t("signOn.go")}
        </Button>
      </form>
    </Panel>
  );
}

function Refused({ error, isSignedIn }: { error: Error; isSignedIn: boolean }) {
  const { t } = useTranslation();
  return (
    <Panel className={styles.card} floating>
      <div role="alert">
        <EmptyState
          as="h1"
          icon={<CircleAlert size={20} />}
          title={t("signOn.failed")}
          text={problemText(error, t("shell.problem.screen"))}
        >
          <Button component={Link} to={isSignedIn ? "/account" : "/sign-in"} variant="default">
            {t(isSignedIn ? "signOn.toAccount" : "signOn.back")}
          </Button>
        </EmptyState>
      </div>
    </Panel>
  );
}

/** While a code is awaited, a wrong one and too many of them are told in its form. */
const IN_FORM = new Set(["second_factor_needed", "wrong_code", "too_many_attempts"]);

function Finishing({ provider, isSignedIn }: { provider: string; isSignedIn: boolean }) {
  const { t } = useTranslation();
  const [answer] = useState(readAnswer);
  const [asks, setAsks] = useState(false);
  const finish = useFinish(provider);
  const title = useProviders().data?.find(({ name }) => name === provider)?.title ?? provider;
  const begun = useRef(false);
  const { mutate } = finish;
  useEffect(() => {
    if (begun.current) return;
    begun.current = true;
    // Neither the history nor a bookmark keeps what the provider gave along.
    history.replaceState(history.state, "", location.pathname);
    mutate(answer);
  }, [answer, mutate]);
  const problem = finish.error instanceof ApiProblem ? finish.error : null;
  if (problem?.code === "second_factor_needed" && !asks) setAsks(true);
  const shown = useRef<ApiProblem | null>(null);
  if (problem) shown.current = problem;
  if (asks && (!problem || IN_FORM.has(problem.code)) && shown.current && !finish.isSuccess)
    return (
      <AskFactor
        title={title}
        error={shown.current}
        busy={finish.isPending}
        send={(factor) => mutate({ ...answer, factor })}
      />
    );
  if (finish.error) return <Refused error={finish.error} isSignedIn={isSignedIn} />;
  return (
    <>
      <p className="visually-hidden">{t("signOn.under")}</p>
      <Waiting />
    </>
  );
}

export function SignOnPage() {
  const { t } = useTranslation();
  const { provider = "" } = useParams();
  const me = useMe();
  useTitle(t("signOn.page"));
  // `/me` gives the token that finishing needs.
  return (
    <main className={styles.page}>
      {me.isPending ? <Waiting /> : <Finishing provider={provider} isSignedIn={Boolean(me.data?.user)} />}
    </main>
  );
}
