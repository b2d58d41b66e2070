/** One's own account: another password, where one is signed in, and an end of that. */
import { Button, PasswordInput } from "@mantine/core";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { LogOut } from "lucide-react";
import { useState, type FormEvent } from "react";
import { useTranslation } from "react-i18next";
import { api, ApiProblem, rememberCsrf } from "@/api/client";
import { keys, useMe } from "@/api/queries";
import type { Me, User } from "@/api/types";
import { Panel } from "@/design/Panel";
import { PageShell } from "@/shell/PageShell";
import { SignOutQuestion, useSignOut } from "@/shell/SignOut";
import styles from "./account.module.css";
import { Mail } from "./Mail";
import { NameForm } from "./NameForm";
import { SecondFactor } from "./SecondFactor";
import { SessionList } from "./SessionList";
import { Told } from "./Told";
import { WaysIn } from "./WaysIn";
import { useWaysIn } from "./waysIn";

const EMPTY = { old: "", new: "" };

function useChangePassword(onDone: () => void) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: (words: typeof EMPTY) => api.post<Me>("/me/password", words),
    onSuccess: (me) => {
      rememberCsrf(me.csrf);
      queries.setQueryData(keys.me, me);
      onDone();
    },
  });
}

function PasswordForm({ user }: { user: User }) {
  const { t } = useTranslation();
  const [words, setWords] = useState(EMPTY);
  const change = useChangePassword(() => setWords(EMPTY));
  const write = (some: Partial<typeof EMPTY>) => {
    if (!change.isIdle) change.reset();
    setWords({ ...words, ...some });
  };
  const submit = (event: FormEvent) => {
    event.preventDefault();
    change.mutate(words);
  };
  const code = change.error instanceof ApiProblem ? change.error.code : "";
  return (
    <Panel className={styles.card}>
      <form className={styles.form} onSubmit={submit}>
        <div>
          <h2>{t("pages.account.password")}</h2>
          <p>{t("pages.account.passwordText")}</p>
        </div>
        <input
          type="text"
          className="visually-hidden"
          tabIndex={-1}
          aria-hidden="true"
          autoComplete="username"
          value={user.email}
          readOnly
        />
        <PasswordInput
          label={t("pages.account.old")}
          autoComplete="current-password"
          required
          withAsterisk={false}
          value={words.old}
          error={code === "wrong_old_password"}
          onChange={(event) => write({ old: event.target.value })}
        />
        <PasswordInput
          label={t("pages.account.new")}
          description={t("pages.account.newHint")}
          autoComplete="new-password"
          required
          withAsterisk={false}
          value={words.new}
          error={code === "bad_password"}
          onChange={(event) => write({ new: event.target.value })}
        />
        <Told error={change.error} done={change.isSuccess ? t("pages.account.changed") : ""} />
        <Button type="submit" loading={change.isPending} disabled={!words.old || !words.new}>
          {t("pages.account.change")}
        </Button>
      </form>
    </Panel>
  );
}

function Sessions() {
  const { t } = useTranslation();
  const end = useSignOut("/me/sign-out-everywhere");
  return (
    <Panel className={styles.card}>
      <div className={styles.form}>
        <SignOutQuestion signOut={end} />
        <SessionList ending={end.isPending || end.isSuccess} />
        <p>{t("pages.account.everywhereText")}</p>
        <Button
          variant="default"
          leftSection={<LogOut size={16} aria-hidden="true" />}
          loading={end.isPending}
          onClick={end.ask}
        >
          {t("pages.account.everywhere")}
        </Button>
      </div>
    </Panel>
  );
}

export function AccountPage() {
  const { t } = useTranslation();
  const user = useMe().data?.user;
  const ways = useWaysIn().data;
  return (
    <PageShell title={t("pages.account.title")}>
      {user ? (
        <div className={styles.page}>
          <div className={styles.who}>
            <strong>{user.name}</strong>
            <span>{user.email}</span>
          </div>
          <NameForm user={user} />
          {ways?.has_password === false ? null : <PasswordForm user={user} />}
          <WaysIn />
          <SecondFactor />
          <Mail />
          <Sessions />
        </div>
      ) : null}
    </PageShell>
  );
}
