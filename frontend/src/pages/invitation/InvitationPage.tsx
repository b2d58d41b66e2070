/** Where the link of an invitation leads: what it offers, and the two ways in. */
import { Button, PasswordInput, TextInput } from "@mantine/core";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { CircleAlert } from "lucide-react";
import { useState, type FormEvent, type ReactNode } from "react";
import { useTranslation } from "react-i18next";
import { Link, useLocation, useNavigate, type To } from "react-router-dom";
import { api, ApiProblem } from "@/api/client";
import { keys, useMe } from "@/api/queries";
import type { Me, NewPerson, Offer, User } from "@/api/types";
import { EmptyState } from "@/design/EmptyState";
import { Logo } from "@/design/Logo";
import { Panel } from "@/design/Panel";
import { useTitle } from "@/shell/useTitle";
import { LoadProblem, problemText, Waiting } from "@/shell/LoadProblem";
import { SignOutQuestion, useSignOut } from "@/shell/SignOut";
import { ProviderButtons } from "../signin/ProviderButtons";
import { useProviders } from "../signin/providers";
import sign from "../signin/SignInPage.module.css";
import styles from "./invitation.module.css";

const EMPTY = { name: "", email: "", password: "" };

const useOffer = (code: string) =>
  useQuery({
    queryKey: ["invitation", code],
    queryFn: () => api.post<Offer>("/invitations/look", { code }),
    enabled: code !== "",
  });

/** Go to the site that somebody has come in to, with all that is known of them asked for anew. */
function useEnter() {
  const queries = useQueryClient();
  const navigate = useNavigate();
  return async ({ site }: { site: string }) => {
    await queries.invalidateQueries({ queryKey: keys.me });
    await queries.invalidateQueries({ queryKey: keys.sites });
    await navigate(`/sites/${site}/programs`);
  };
}

function Refused({ error }: { error: Error | null }) {
  const { t } = useTranslation();
  if (!error) return null;
  return (
    <p className={sign.refused} role="alert">
      <CircleAlert size={16} aria-hidden="true" />
      {problemText(error, t("shell.problem.screen"))}
    </p>
  );
}

function AsNew({ code }: { code: string }) {
  const { t } = useTranslation();
  const [who, setWho] = useState(EMPTY);
  const enter = useEnter();
  const join = useMutation({
    mutationFn: (person: NewPerson) => api.post<{ site: string }>("/invitations/join", person),
    onSuccess: enter,
  });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    join.mutate({ code, ...who });
  };
  const set = (some: Partial<typeof EMPTY>) => setWho({ ...who, ...some });
  const refusedFor = join.error instanceof ApiProblem ? join.error.code : "";
  return (
    <section className={styles.way} aria-labelledby="as-new">
      <h2 id="as-new">{t("people.join.new")}</h2>
      <form className={sign.form} onSubmit={submit}>
        <TextInput
          label={t("people.join.name")}
          description={t("people.join.nameHint")}
          autoComplete="name"
          maxLength={100}
          required
          withAsterisk={false}
          value={who.name}
          onChange={(event) => set({ name: event.target.value })}
        />
        <TextInput
          label={t("people.join.email")}
          type="email"
          autoComplete="username"
          maxLength={254}
          required
          withAsterisk={false}
          value={who.email}
          error={refusedFor === "bad_person"}
          onChange={(event) => set({ email: event.target.value })}
        />
        <PasswordInput
          label={t("people.join.password")}
          description={t("people.join.passwordHint")}
          autoComplete="new-password"
          required
          withAsterisk={false}
          value={who.password}
          error={refusedFor === "bad_password"}
          onChange={(event) => set({ password: event.target.value })}
        />
        <Refused error={join.error} />
        <Button type="submit" loading={join.isPending}>
          {t("people.join.make")}
        </Button>
      </form>
    </section>
  );
}

/** Nothing where nobody signs in by a provider. */
function ByProvider({ code }: { code: string }) {
  const { t } = useTranslation();
  const providers = useProviders();
  if (!providers.data?.length) return null;
  return (
    <section className={styles.way} aria-labelledby="by-provider">
      <h2 id="by-provider">{t("signOn.join")}</h2>
      <p>{t("signOn.joinText")}</p>
      <ProviderButtons invitation={code} />
    </section>
  );
}

/** Signing in, and from there back here. The code stays behind the sign #: no log of a server or proxy has it. */
function useWayToSignIn(): To {
  const { pathname, hash } = useLocation();
  return { pathname: "/sign-in", search: `?next=${pathname}`, hash };
}

function WithAccount() {
  const { t } = useTranslation();
  const to = useWayToSignIn();
  return (
    <section className={styles.way} aria-labelledby="with-account">
      <h2 id="with-account">{t("people.join.have")}</h2>
      <p>{t("people.join.haveText")}</p>
      <Button component={Link} variant="default" to={to}>
        {t("people.join.signIn")}
      </Button>
    </section>
  );
}

function AsMyself({ code, user }: { code: string; user: User }) {
  const { t } = useTranslation();
  const enter = useEnter();
  const accept = useMutation({
    mutationFn: () => api.post<{ site: string }>("/invitations/accept", { code }),
    onSuccess: enter,
  });
  const other = useSignOut("/sign-out", useWayToSignIn());
  return (
    <section className={sign.form}>
      <SignOutQuestion signOut={other} />
      <p>{t("people.join.signedInAs", { name: user.email })}</p>
      <Refused error={accept.error} />
      <Button size="md" loading={accept.isPending} onClick={() => accept.mutate()}>
        {t("people.join.accept", { name: user.name })}
      </Button>
      <Button variant="subtle" onClick={other.ask}>
        {t("people.join.other")}
      </Button>
    </section>
  );
}

function OfferCard({ offer, code, me }: { offer: Offer; code: string; me: Me }) {
  const { t } = useTranslation();
  const { invited_by: by, site_name: site } = offer;
  return (
    <Panel className={sign.card} floating>
      <div className={sign.brand}>
        <Logo size={34} />
        <div>
          <h1>{t("people.join.title")}</h1>
          <p>{t(by ? "people.join.text" : "people.join.textNobody", { by, site })}</p>
          <p>{t("people.join.as", { role: t(`role.${offer.role}`) })}</p>
        </div>
      </div>
      {me.user ? (
        <AsMyself code={code} user={me.user} />
      ) : (
        <>
          <AsNew code={code} />
          <ByProvider code={code} />
          <WithAccount />
        </>
      )}
    </Panel>
  );
}

function NoWayIn({ title, text }: { title: string; text: string }) {
  const { t } = useTranslation();
  return (
    <Panel className={sign.card} floating>
      <EmptyState as="h1" icon={<CircleAlert size={20} />} title={title} text={text}>
        <Button component={Link} to="/" variant="default">
          {t("people.join.home")}
        </Button>
      </EmptyState>
    </Panel>
  );
}

function useCard(code: string): ReactNode {
  const { t } = useTranslation();
  const me = useMe();
  const offer = useOffer(me.data ? code : "");
  if (code === "") return <NoWayIn title={t("people.join.unknown")} text={t("people.join.noCode")} />;
  if (me.isLoadingError) return <LoadProblem error={me.error} again={() => void me.refetch()} />;
  const refused = offer.error instanceof ApiProblem ? offer.error : null;
  if (refused && refused.status >= 400 && refused.status < 500)
    return (
      <NoWayIn
        title={t(refused.code === "link_over" ? "people.join.over" : "people.join.unknown")}
        text={refused.message}
      />
    );
  if (offer.isLoadingError) return <LoadProblem error={offer.error} again={() => void offer.refetch()} />;
  if (!me.data || !offer.data) return <Waiting />;
  return <OfferCard offer={offer.data} code={code} me={me.data} />;
}

export function InvitationPage() {
  const { t } = useTranslation();
  const code = useLocation().hash.slice(1);
  useTitle(t("people.join.title"));
  return <main className={sign.page}>{useCard(code)}</main>;
}
