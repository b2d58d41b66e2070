/** Signing in; a demo offers its accounts. */
import { Button, PasswordInput, TextInput } from "@mantine/core";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { ArrowRight, CircleAlert } from "lucide-react";
import { useState, type FormEvent } from "react";
import { useTranslation } from "react-i18next";
import { Navigate, useLocation, useSearchParams } from "react-router-dom";
import { LoadProblem, problemText, Waiting } from "@/shell/LoadProblem";
import { api, ApiProblem, rememberCsrf } from "@/api/client";
import { keys, useMe } from "@/api/queries";
import type { Me } from "@/api/types";
import { Avatar } from "@/design/Avatar";
import { Logo } from "@/design/Logo";
import { Panel } from "@/design/Panel";
import { takeKeyboard } from "@/design/takeKeyboard";
import { useTitle } from "@/shell/useTitle";
import { useWaitingCount } from "@/shell/waitingCopies";
import { ProviderButtons } from "./ProviderButtons";
import { safeNext } from "./safeNext";
import styles from "./SignInPage.module.css";

interface Credentials {
  email: string;
  password: string;
  code?: string;
}

function useSignIn() {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: (who: Credentials) => api.post<Me>("/sign-in", who),
    onSuccess: (me) => {
      rememberCsrf(me.csrf);
      queries.setQueryData(keys.me, me);
    },
  });
}

function DemoAccounts({
  accounts,
  busy,
  use,
}: {
  accounts: Me["demo_accounts"];
  busy: boolean;
  use: (who: Me["demo_accounts"][number]) => void;
}) {
  const { t } = useTranslation();
  if (accounts.length === 0) return null;
  return (
    <section className={styles.demo} aria-labelledby="demo-accounts">
      <h2 id="demo-accounts">{t("pages.signIn.demo")}</h2>
      {accounts.map((account) => (
        <button key={account.email} type="button" disabled={busy} onClick={() => use(account)}>
          <Avatar name={account.role} initials={account.role.slice(0, 2).toUpperCase()} size={30} />
          <span>
            <strong>{t(`pages.signIn.as.${account.role}`)}</strong>
            <small>{t(`shell.role.${account.role}`)}</small>
          </span>
          <ArrowRight size={16} aria-hidden="true" />
        </button>
      ))}
    </section>
  );
}

function SignInForm({ me, next }: { me: Me; next: string }) {
  const { t } = useTranslation();
  const [who, setWho] = useState<Credentials>({ email: "", password: "" });
  const signIn = useSignIn();
  const waiting = useWaitingCount();
  const refusedFor = signIn.error instanceof ApiProblem ? signIn.error.code : "";
  const [asksCode, setAsksCode] = useState(false);
  if (refusedFor === "second_factor_needed" && !asksCode) setAsksCode(true);
  const submit = (event: FormEvent) => {
    event.preventDefault();
    signIn.mutate(who);
  };
  const use = ({ email, password }: Me["demo_accounts"][number]) => {
    setWho({ email, password });
    signIn.mutate({ email, password });
  };
  return (
    <Panel className={styles.card} floating>
      <div className={styles.brand}>
        <Logo size={34} />
        <div>
          <h1>{t("pages.signIn.title")}</h1>
          <p>{t("pages.signIn.text")}</p>
        </div>
      </div>
      {waiting > 0 ? <p role="status">{t("shell.waiting.signedOut", { count: waiting })}</p> : null}
      <form className={styles.form} onSubmit={submit}>
        <TextInput
          label={t("pages.signIn.email")}
          type="email"
          autoComplete="username"
          required
          withAsterisk={false}
          value={who.email}
          onChange={(event) => {
            setWho({ ...who, email: event.target.value, code: "" });
            setAsksCode(false);
            signIn.reset();
          }}
        />
        <PasswordInput
          label={t("pages.signIn.password")}
          autoComplete="current-password"
          required
          withAsterisk={false}
          value={who.password}
          onChange={(event) => setWho({ ...who, password: event.target.value })}
        />
        {asksCode ? (
          <TextInput
            label={t("factor.signIn")}
            description={t("factor.signInHint")}
            autoComplete="one-time-code"
            ref={takeKeyboard}
            required
            withAsterisk={false}
            maxLength={40}
            value={who.code ?? ""}
            error={refusedFor === "wrong_code"}
            onChange={(event) => setWho({ ...who, code: event.target.value })}
          />
        ) : null}
        {asksCode ? <p>{t("factor.lost")}</p> : null}
        {signIn.isError && refusedFor !== "second_factor_needed" ? (
          <p className={styles.refused} role="alert">
            <CircleAlert size={16} aria-hidden="true" />
            {problemText(signIn.error, t("shell.problem.screen"))}
          </p>
        ) : null}
        <Button type="submit" size="md" loading={signIn.isPending}>
          {t("pages.signIn.go")}
        </Button>
      </form>
      <ProviderButtons next={next} />
      <DemoAccounts accounts={me.demo_accounts} busy={signIn.isPending} use={use} />
    </Panel>
  );
}

export function SignInPage() {
  const { t } = useTranslation();
  const me = useMe();
  const next = safeNext(useSearchParams()[0].get("next"));
  const { hash } = useLocation();
  useTitle(t("pages.signIn.go"));
  if (me.isPending) return <Waiting />;
  if (me.isLoadingError) return <LoadProblem error={me.error} again={() => void me.refetch()} />;
  if (me.data.user) return <Navigate to={next + hash} replace />;
  return (
    <main className={styles.page}>
      <SignInForm me={me.data} next={next} />
    </main>
  );
}
